// A simulated P3-AT with its own line, run by a thread in real time.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "realtime/clock.h"
#include "sim/transport/robot_server.h"

namespace heel::test {

class RobotThread {
 public:
  explicit RobotThread(const std::string& address, int baud = 38400) : robot_(settings(baud)) {
    transport_ = sim::open_transport(address, baud);
    thread_ = std::thread([this] { run(); });
  }
  ~RobotThread() {
    stop_ = true;
    thread_.join();
  }
  std::string address() const { return transport_->address(); }
  void press_stop_button(bool pressed) { button_ = pressed; }
  sim::RobotTruth truth() const {
    const std::lock_guard lock(mutex_);
    return truth_;
  }

 private:
  static sim::P3AtSettings settings(int baud) {
    sim::P3AtSettings settings;
    settings.boot_baud = baud;
    return settings;
  }
  void run() {
    sim::RobotServer server(robot_, *transport_, [](TimeNs, const std::string&) {});
    const TimeNs begin_ns = monotonic_now_ns();
    while (!stop_) {
      robot_.press_stop_button(button_);
      server.step(monotonic_now_ns() - begin_ns);
      {
        const std::lock_guard lock(mutex_);
        truth_ = robot_.truth();
      }
      sleep_until_ns(monotonic_now_ns() + kNsPerMs);
    }
  }
  sim::P3At robot_;
  std::unique_ptr<sim::Transport> transport_;
  mutable std::mutex mutex_;
  sim::RobotTruth truth_;
  std::atomic<bool> button_{false};
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

inline std::string pty_address(const char* name) {
  return "pty:" + testing::TempDir() + "heel-" + name + "-" + std::to_string(::getpid());
}

}  // namespace heel::test
