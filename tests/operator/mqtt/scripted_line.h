// A line to a broker that a test plays, and what was published over it.
#pragma once

#include <deque>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "operator/mqtt/broker_line.h"
#include "realtime/clock.h"

namespace heel::test {

using Published = std::pair<std::string, std::string>;  // topic, text

/// Outlives the line, which the publisher owns.
struct PlayedBroker {
  std::mutex mutex;
  std::deque<std::string> problems;  ///< of the next attempts to connect; then all succeed
  bool confirms = true;
  bool breaks = false;  ///< the connection is lost at the next look
  std::vector<Published> published;
  std::vector<TimeNs> t_attempts_ns;
  bool left = false;  ///< disconnect() was called

  std::size_t attempts() {
    const std::lock_guard lock(mutex);
    return t_attempts_ns.size();
  }
  std::vector<Published> all() {
    const std::lock_guard lock(mutex);
    return published;
  }
  void set(bool PlayedBroker::*member, bool value) {
    const std::lock_guard lock(mutex);
    this->*member = value;
  }
};

class ScriptedLine final : public BrokerLine {
 public:
  explicit ScriptedLine(PlayedBroker& broker) : broker_(broker) {}

  std::string connect() override {
    const std::lock_guard lock(broker_.mutex);
    broker_.t_attempts_ns.push_back(monotonic_now_ns());
    broker_.breaks = false;
    if (broker_.problems.empty()) return "";
    std::string problem = broker_.problems.front();
    broker_.problems.pop_front();
    return problem;
  }
  bool publish(const std::string& topic, const std::string& text) override {
    const std::lock_guard lock(broker_.mutex);
    broker_.published.emplace_back(topic, text);
    return true;
  }
  bool confirmed() override {
    const std::lock_guard lock(broker_.mutex);
    return broker_.confirms;
  }
  bool serve(TimeNs wait_ns) override {
    sleep_until_ns(monotonic_now_ns() + wait_ns / 10);
    const std::lock_guard lock(broker_.mutex);
    return !broker_.breaks;
  }
  void disconnect() override { broker_.set(&PlayedBroker::left, true); }

 private:
  PlayedBroker& broker_;
};

}  // namespace heel::test
