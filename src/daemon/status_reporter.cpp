#include "daemon/status_reporter.h"

#include <spdlog/spdlog.h>

#include "core/state_sentence.h"

namespace heel {
namespace {

constexpr TimeNs kControlTimeout_ns = 500 * kNsPerMs;  // an older tick: the watchdog is not fed

}  // namespace

void StatusReporter::update(ControlLoop& control, bool frame_seen, TimeNs now_ns) {
  control.take_status(tick_);
  frame_seen_ = frame_seen;
  log_link_errors(control);
  if (!complete_ && robot_has_answered() && frame_seen_) {
    complete_ = true;
    spdlog::info("the robot has answered and the first frame has arrived");
  }
  if (!ready_ && ready_by_now()) {
    ready_ = true;
    notifier_.ready();
    spdlog::info("ready");
  }
  notifier_.status(status_line());
  if (now_ns - control.heartbeat_ns() < kControlTimeout_ns) notifier_.alive(now_ns);
}

void StatusReporter::reload_ended() {
  // For systemd READY ends a reload. Before the daemon is ready there is nothing to repeat.
  if (ready_) notifier_.ready();
}

bool StatusReporter::at_rest() const {
  return tick_.stop_reason != StopReason::None && tick_.command.v_m_s == 0.0 &&
         tick_.command.yaw_rate_rad_s == 0.0;
}

void StatusReporter::log_link_errors(const ControlLoop& control) {
  if (control.open_notes() != seen_open_notes_) {
    seen_open_notes_ = control.open_notes();
    spdlog::warn("{}", control.last_open_note());
  }
  if (robot_has_answered()) logged_open_error_.clear();
  const std::uint64_t failures = control.open_failures();
  if (failures == seen_open_failures_) return;
  seen_open_failures_ = failures;
  // Once for each reason in an outage, not for each attempt.
  std::string error = control.last_open_error();
  if (error == logged_open_error_) return;
  spdlog::warn("{}; heeld tries again", error);
  logged_open_error_ = std::move(error);
}

bool StatusReporter::robot_has_answered() const {
  const LinkPhase phase = tick_.input.robot.phase;
  return tick_.input.robot.has_sip && (phase == LinkPhase::Running || phase == LinkPhase::Disabled);
}

bool StatusReporter::ready_by_now() const {
  return complete_ || ready_after_ == "start" || (ready_after_ == "robot" && robot_has_answered());
}

std::string StatusReporter::status_line() const {
  if (tick_.input.robot.phase == LinkPhase::Refused) return state_sentence(tick_);
  if (!complete_) {
    const std::string robot =
        robot_has_answered() ? "" : fmt::format("the robot ({})", to_string(tick_.input.robot.phase));
    const char* const camera = frame_seen_ ? "" : "the camera";
    const char* const both = robot.empty() || frame_seen_ ? "" : " and ";
    return fmt::format("waiting for {}{}{}", robot, both, camera);
  }
  return state_sentence(tick_);
}

}  // namespace heel
