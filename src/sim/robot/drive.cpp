#include "sim/robot/drive.h"

#include <cmath>
#include <numbers>

#include "core/angles.h"

namespace heel::sim {

Drive::Drive(const AxisLimits& translation_m, const AxisLimits& rotation_rad, double effective_track_m)
    : translation_limits(translation_m),
      rotation_limits(rotation_rad),
      effective_track_m_(effective_track_m) {}

void Drive::set_speed(double v_m_s) {
  moves_to_goal_ = false;
  speed_setpoint_m_s_ = v_m_s;
}

void Drive::move(double distance_m, double travelled_m) {
  moves_to_goal_ = true;
  goal_m_ = travelled_m + distance_m;
}

void Drive::set_yaw_rate(double yaw_rate_rad_s) {
  holds_heading_ = false;
  yaw_rate_setpoint_rad_s_ = yaw_rate_rad_s;
}

void Drive::turn_to(double heading_rad) {
  holds_heading_ = true;
  heading_setpoint_rad_ = heading_rad;
}

void Drive::set_wheels(const WheelSpeeds& wheels) {
  set_speed(0.5 * (wheels.left_m_s + wheels.right_m_s));
  set_yaw_rate((wheels.right_m_s - wheels.left_m_s) / effective_track_m_);
}

void Drive::stop() {
  set_speed(0.0);
  set_yaw_rate(0.0);
}

void Drive::emergency_stop() {
  stop();
  translation_.set_speed(0.0);
  rotation_.set_speed(0.0);
}

WheelSpeeds Drive::step(const Progress& now, bool stopped_by_watchdog, double dt_s) {
  step_translation(now.travelled_m, stopped_by_watchdog, dt_s);
  step_rotation(now.heading_rad, stopped_by_watchdog, dt_s);
  const double half_difference_m_s = 0.5 * rotation_.speed() * effective_track_m_;
  return {translation_.speed() - half_difference_m_s, translation_.speed() + half_difference_m_s};
}

void Drive::follow(const WheelSpeeds& wheels) {
  translation_.set_speed(0.5 * (wheels.left_m_s + wheels.right_m_s));
  rotation_.set_speed((wheels.right_m_s - wheels.left_m_s) / effective_track_m_);
}

int Drive::direction(double travelled_m) const {
  const double setpoint = moves_to_goal_ ? goal_m_ - travelled_m : speed_setpoint_m_s_;
  return setpoint > 0.0 ? 1 : setpoint < 0.0 ? -1 : 0;
}

bool Drive::has_motion_to_do(const Progress& now) const {
  constexpr double kHeadingReached_rad = 1e-3;
  const bool turns =
      holds_heading_ ? std::abs(wrap_angle_rad(heading_setpoint_rad_ - now.heading_rad)) > kHeadingReached_rad
                     : yaw_rate_setpoint_rad_s_ != 0.0;
  return turns || direction(now.travelled_m) != 0;
}

void Drive::step_translation(double travelled_m, bool stopped_by_watchdog, double dt_s) {
  if (stopped_by_watchdog || !moves_to_goal_) {
    translation_.step_to_speed(stopped_by_watchdog ? 0.0 : speed_setpoint_m_s_, translation_limits, dt_s);
    return;
  }
  if (translation_.step_to_distance(goal_m_ - travelled_m, translation_limits, dt_s)) set_speed(0.0);
}

void Drive::step_rotation(double heading_rad, bool stopped_by_watchdog, double dt_s) {
  if (stopped_by_watchdog || !holds_heading_) {
    rotation_.step_to_speed(stopped_by_watchdog ? 0.0 : yaw_rate_setpoint_rad_s_, rotation_limits, dt_s);
    return;
  }
  rotation_.step_to_distance(wrap_angle_rad(heading_setpoint_rad_ - heading_rad), rotation_limits, dt_s);
}

}  // namespace heel::sim
