#include "control/conditions.h"

#include <algorithm>

namespace heel {
namespace {

bool link_is_up(LinkPhase phase) {
  // In Disabled the line is up and the motors are off, which is a condition of its own.
  return phase == LinkPhase::Running || phase == LinkPhase::Disabled;
}

bool older_than(TimeNs t_ns, TimeNs now_ns, double limit_s) {
  return now_ns - t_ns > ns_from_seconds(limit_s);
}

TimeNs newest_front_reading_ns(const RobotState& robot) {
  TimeNs newest_ns = 0;
  for (std::size_t i = 0; i < kSonars / 2; ++i) newest_ns = std::max(newest_ns, robot.sonar[i].t_ns);
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
                                    const SupervisorConfig& config, bool sonar_on) {
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
  set(kMotorsOff, !robot.motors_enabled);
  set(kBumper, held((robot.bumpers_front | robot.bumpers_rear) != 0, ever_bumped_, t_last_bump_ns_, now_ns,
                    config.bumper_hold_s));
  set(kStall, held(robot.stall_left || robot.stall_right, ever_stalled_, t_last_stall_ns_, now_ns,
                   config.bumper_hold_s));
  set(kSonarSilent, sonar_on && older_than(newest_front_reading_ns(robot), now_ns, config.sonar_timeout_s));
  set(kStaleFrame, !input.has_pose || older_than(input.pose.t_capture_ns, now_ns, config.frame_timeout_s));
  set(kLowCertainty,
      !following_ && input.has_pose && input.pose.found() && input.pose.certainty < config.certainty_follow);
  set(kTargetLost, !following_ && ever_followed_);
  set(kNoTargetYet, !following_ && !ever_followed_);
  return bits;
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
