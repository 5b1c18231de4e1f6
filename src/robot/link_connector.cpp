#include "robot/link_connector.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "realtime/schedule.h"

namespace heel {

LinkConnector::LinkConnector(RobotAddress address, TimeNs pause_ns)
    : address_(std::move(address)), pause_ns_(pause_ns), thread_([this] { run(); }) {}

LinkConnector::~LinkConnector() {
  quit_.store(true);
  owner_.store(Owner::Quit, std::memory_order_release);
  owner_.notify_one();
  thread_.join();
}

void LinkConnector::hand_over(Owner to, int baud) {
  baud_ = baud;
  owner_.store(to, std::memory_order_release);
  owner_.notify_one();
}

std::string LinkConnector::last_error() const {
  const std::lock_guard lock(error_mutex_);
  return error_;
}

std::string LinkConnector::last_note() const {
  const std::lock_guard lock(error_mutex_);
  return note_;
}

void LinkConnector::run() {
  name_thread(ThreadRole::Link);
  while (!quit_.load()) {
    const Owner owner = owner_.load(std::memory_order_acquire);
    if (owner == Owner::None || owner == Owner::Caller) {
      owner_.wait(owner, std::memory_order_acquire);
      continue;
    }
    if (owner == Owner::Quit) return;
    const bool retuned = owner == Owner::ConnectorRetunes && line_.set_baud(baud_);
    if (!retuned && !open_until_success()) return;
    Owner expected = owner;  // Quit may have been set meanwhile
    owner_.compare_exchange_strong(expected, Owner::Caller, std::memory_order_acq_rel);
  }
}

bool LinkConnector::open_until_success() {
  line_.close();
  while (!quit_.load()) {
    if (tried_before_) pause();
    tried_before_ = true;
    if (line_.open(address_, baud_)) {
      if (line_.note().empty()) return true;
      const std::lock_guard lock(error_mutex_);
      note_ = line_.note();
      notes_.fetch_add(1, std::memory_order_relaxed);
      return true;
    }
    {
      const std::lock_guard lock(error_mutex_);
      error_ = line_.error();
    }
    failures_.fetch_add(1, std::memory_order_relaxed);
  }
  return false;
}

void LinkConnector::pause() {
  constexpr TimeNs kStep_ns = 20 * kNsPerMs;  // so that quitting does not wait for the whole pause
  for (TimeNs waited_ns = 0; waited_ns < pause_ns_ && !quit_.load(); waited_ns += kStep_ns) {
    std::this_thread::sleep_for(std::chrono::nanoseconds(std::min(kStep_ns, pause_ns_ - waited_ns)));
  }
}

}  // namespace heel
