// The daemon's state for systemd and the log, reported by the main thread: ready, the status line, errors of
// the robot's line, the watchdog.
#pragma once

#include <cstdint>
#include <string>

#include "core/config.h"
#include "daemon/control_loop.h"
#include "daemon/service_notifier.h"
#include "heel/flow.h"

namespace heel {

class StatusReporter {
 public:
  explicit StatusReporter(const RuntimeConfig& config) : ready_after_(config.ready_after) {}

  /// To be called some times a second: reports what has changed, and feeds systemd's watchdog while the
  /// control loop runs. `frame_seen`: the camera has given a frame.
  void update(ControlLoop& control, bool frame_seen, TimeNs now_ns);
  void reload_started(TimeNs now_ns) { notifier_.reloading(now_ns); }
  void reload_ended();
  void stopping() { notifier_.stopping(); }
  /// Sends systemd again what it did not take before.
  void send_kept() { notifier_.send_kept(); }

  /// True: the newest tick stopped the robot, and its command is zero.
  bool at_rest() const;

 private:
  void log_link_errors(const ControlLoop& control);
  bool robot_has_answered() const;
  bool ready_by_now() const;
  std::string status_line() const;

  const std::string ready_after_;
  ServiceNotifier notifier_;
  TickRecord tick_;
  bool frame_seen_ = false;
  bool complete_ = false;  // the robot had answered and a frame had come at the same time
  bool ready_ = false;     // and systemd has been notified
  std::uint64_t seen_open_failures_ = 0;
  std::uint64_t seen_open_notes_ = 0;
  std::string logged_open_error_;  // empty: none since the robot last answered
};

}  // namespace heel
