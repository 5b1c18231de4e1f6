#include "control/conditions.h"

#include <algorithm>

namespace heel {
namespace {

// The voltage dips below the battery's own while the motors start.
constexpr TimeNs kBatteryDip_ns = 2 * kNsPerS;
// Farther than any delay between two reads of the clock in one tick.
constexpr TimeNs kClockStep_ns = 500 * kNsPerMs;

bool link_is_up(LinkPhase phase) {
  // In Disabled the line is up and the motors are off, which is a condition of its own.
  return phase == LinkPhase::Running || phase == LinkPhase::Disabled;
}

bool older_than(TimeNs t_ns, TimeNs now_ns, double limit_s) {
  return now_ns - t_ns > ns_from_seconds(limit_s);
}

TimeNs newest_front_reading_ns(const RobotState& robot, const RobotGeometry& geometry) {
  TimeNs newest_ns = 0;
  for (std::size_t i = 0; i < kMaxSonars; ++i) {
    if (geometry.looks_ahead(i)) newest_ns = std::max(newest_ns, robot.sonar[i].t_ns);
  }
  return newest_ns;
}

/// True while `active` and for `hold_s` after the last time it was.
bool held(bool active, bool& ever_active, TimeNs& t_last_active_ns, TimeNs now_ns, double hold_s) {
  if (active) {
    ever_active = true;
    t_last_active_ns = now_ns;
  }
  return active || (ever_active && !older_than(t_last_active_ns, now_ns, hold_s));
}

}  // namespace

Conditions ConditionMonitor::update(const ControlInput& input, MeasurementStatus measurement,
                                    const SupervisorConfig& config, const RobotGeometry& geometry,
                                    bool sonar_on, OperatorCommand command, bool turns_away) {
  const RobotState& robot = input.robot;
  const TimeNs now_ns = input.now_ns;
  update_following(input, measurement, config);

  Conditions bits = 0;
  const auto set = [&bits](Condition condition, bool holds) {
    if (holds) bits |= condition;
  };
  set(kShutdown, input.shutdown);
  set(kLinkDown, !link_is_up(robot.phase));
  set(kStaleSip, !robot.has_sip || older_than(robot.odometry.t_ns, now_ns, config.sip_timeout_s));
  set(kStopButton, robot.stop_button || robot.e_stall);
  set(kMotorsOff, motors_off(robot, command));
  set(kBumper, held((robot.bumpers_front | robot.bumpers_rear) != 0, ever_bumped_, t_last_bump_ns_, now_ns,
                    config.bumper_hold_s));
  set(kStall, held(robot.stall_left || robot.stall_right, ever_stalled_, t_last_stall_ns_, now_ns,
                   config.bumper_hold_s));
  set(kSonarSilent,
      sonar_on && older_than(newest_front_reading_ns(robot, geometry), now_ns, config.sonar_timeout_s));
  set(kStaleFrame, !input.has_pose || older_than(input.pose.t_capture_ns, now_ns, config.frame_timeout_s));
  set(kLowCertainty,
      !following_ && input.has_pose && input.pose.found() && input.pose.certainty < config.certainty_follow);
  set(kAmbiguous, !following_ && input.has_pose && input.pose.reason == PoseReason::Ambiguous);
  set(kTargetLost, !following_ && ever_followed_);
  set(kNoTargetYet, !following_ && !ever_followed_);
  set(kBatteryLow, battery_low(robot, now_ns, config));
  set(kOverrun, config.lateness_max_s > 0.0 && input.lateness_ns > ns_from_seconds(config.lateness_max_s));
  set(kClockStep, clock_stepped(input));
  set(kTurnsAway, turns_away);
  set(kOperatorAway,
      config.operator_timeout_s > 0.0 && older_than(input.t_operator_ns, now_ns, config.operator_timeout_s));
  return bits;
}

/// While the session connects and enables them, motors are off without a cause to keep them off.
bool ConditionMonitor::motors_off(const RobotState& robot, OperatorCommand command) {
  const bool off = !robot.motors_enabled || robot.stop_button || robot.e_stall;
  if (command == OperatorCommand::Reset && !robot.stop_button) {
    motors_went_off_ = false;
  } else if (off && link_is_up(robot.phase)) {
    motors_went_off_ = true;
  }
  return !robot.motors_enabled || motors_went_off_;
}

bool ConditionMonitor::battery_low(const RobotState& robot, TimeNs now_ns, const SupervisorConfig& config) {
  // A robot that reports no voltage reports 0.
  if (robot.has_sip && robot.battery_v > 0.0) {
    if (robot.battery_v >= config.battery_low_v || t_battery_fine_ns_ == 0) t_battery_fine_ns_ = now_ns;
    if (robot.battery_v >= config.battery_ok_v) battery_low_ = false;
    if (now_ns - t_battery_fine_ns_ > kBatteryDip_ns) battery_low_ = true;
  }
  if (config.battery_low_v == 0.0) battery_low_ = false;
  return battery_low_;
}

bool ConditionMonitor::clock_stepped(const ControlInput& input) {
  const TimeNs step_ns = input.now_ns - t_last_tick_ns_;
  const bool first = !ticked_;
  ticked_ = true;
  t_last_tick_ns_ = input.now_ns;
  return !first && (step_ns < 0 || step_ns - input.lateness_ns > kClockStep_ns);
}

void ConditionMonitor::update_following(const ControlInput& input, MeasurementStatus measurement,
                                        const SupervisorConfig& config) {
  const double least_certainty = following_ ? config.certainty_drop : config.certainty_follow;
  if (measurement == MeasurementStatus::Accepted && input.pose.certainty >= least_certainty) {
    ++good_frames_in_a_row_;
    t_last_good_frame_ns_ = input.pose.t_capture_ns;
  } else if (measurement != MeasurementStatus::None) {
    good_frames_in_a_row_ = 0;
  }
  const bool expired = older_than(t_last_good_frame_ns_, input.now_ns, config.target_timeout_s);
  if (expired) good_frames_in_a_row_ = 0;  // frames with a long gap between them are not in a row
  following_ = !expired && (following_ || good_frames_in_a_row_ >= config.frames_to_follow);
  ever_followed_ = ever_followed_ || following_;
}

}  // namespace heel
