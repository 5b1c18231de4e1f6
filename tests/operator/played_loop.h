// A control loop that a test plays, for the operator thread.
#pragma once

#include <condition_variable>
#include <mutex>
#include <string>
#include <vector>

#include "operator/operator_port.h"
#include "realtime/clock.h"

namespace heel::test {

/// A control loop that does what it is asked at once: in the tick after the request.
class PlayedLoop final : public OperatorPort {
 public:
  OperatorRequest request(OperatorCommand command, TimeNs t_ns) override {
    const std::lock_guard lock(mutex_);
    const OperatorRequest request{++number_, t_ns, command};
    requests_.push_back(command);
    if (deaf_) return request;
    tick_.request_number = request.number;
    tick_.outcome = OperatorOutcome::Done;
    switch (request.command) {
      case OperatorCommand::Start:
        if (tick_.state == SupervisorState::Emergency) {
          tick_.outcome = OperatorOutcome::Refused;
          tick_.refused_by = StopReason::EmergencyStop;
        } else {
          tick_.state = SupervisorState::Armed;
        }
        break;
      case OperatorCommand::EStop:
        tick_.state = SupervisorState::Emergency;
        break;
      default:
        tick_.state = SupervisorState::Idle;
        break;
    }
    return request;
  }
  void alive(TimeNs) override {
    std::unique_lock lock(mutex_);
    ++signs_of_life_;
    holds_ = held_;
    released_.wait(lock, [this] { return !held_; });
    holds_ = false;
  }
  bool take_tick(TickRecord& out) override {
    const std::lock_guard lock(mutex_);
    tick_.input.now_ns = monotonic_now_ns();
    ++tick_.tick;
    out = tick_;
    return true;
  }
  /// The newest frame, from the next tick on.
  void see(const PoseEstimate& pose) {
    const std::lock_guard lock(mutex_);
    tick_.input.has_pose = true;
    tick_.input.pose = pose;
  }
  CaptureCounters camera() override { return {.captured = 42}; }
  void answered(const std::string& who, const std::string& request, const std::string& answer) override {
    const std::lock_guard lock(mutex_);
    if (!who.empty()) answers_.push_back(request + ": " + answer);
  }
  std::string mark(const std::string& text) override {
    const std::lock_guard lock(mutex_);
    marks_.push_back(text);
    return text == "refuse" ? "nothing is recorded" : "";
  }
  std::vector<std::string> answers() {
    const std::lock_guard lock(mutex_);
    return answers_;
  }
  std::vector<std::string> marks() {
    const std::lock_guard lock(mutex_);
    return marks_;
  }

  void be_deaf() {
    const std::lock_guard lock(mutex_);
    deaf_ = true;
  }
  /// The next request keeps the operator thread until release().
  void hold() {
    const std::lock_guard lock(mutex_);
    held_ = true;
  }
  /// The operator thread is kept.
  bool holds() {
    const std::lock_guard lock(mutex_);
    return holds_;
  }
  void release() {
    const std::lock_guard lock(mutex_);
    held_ = false;
    released_.notify_all();
  }
  /// One in each round of the operator thread, and one for each status.
  std::uint64_t ticks_taken() {
    const std::lock_guard lock(mutex_);
    return tick_.tick;
  }
  int signs_of_life() {
    const std::lock_guard lock(mutex_);
    return signs_of_life_;
  }
  std::vector<OperatorCommand> requests() {
    const std::lock_guard lock(mutex_);
    return requests_;
  }

 private:
  std::mutex mutex_;
  std::uint64_t number_ = 0;
  TickRecord tick_;
  std::vector<std::string> answers_, marks_;
  std::vector<OperatorCommand> requests_;
  int signs_of_life_ = 0;
  bool deaf_ = false, held_ = false, holds_ = false;
  std::condition_variable released_;
};

}  // namespace heel::test
