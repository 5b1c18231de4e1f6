#include "sim/robot/chassis.h"

#include <algorithm>
#include <cmath>

namespace heel::sim {
namespace {

double approach(double value, double target, double step) {
  return value + std::clamp(target - value, -step, step);
}

/// Adds an arc of length `distance_m` that turns by `turn_rad`; exact to second order in the turn.
void add_arc(Pose2& pose, double distance_m, double turn_rad) {
  const double middle_rad = pose.heading_rad + 0.5 * turn_rad;
  pose.x_m += distance_m * std::cos(middle_rad);
  pose.y_m += distance_m * std::sin(middle_rad);
  pose.heading_rad += turn_rad;
}

}  // namespace

ChassisSettings exact_chassis(ChassisSettings settings) {
  settings.true_track_m = settings.effective_track_m;
  settings.track_scale = 1.0;
  settings.left_scale_error = 0.0;
  settings.right_scale_error = 0.0;
  settings.drift_per_sqrt_m = 0.0;
  settings.heading_drift_rad_per_sqrt_m = 0.0;
  return settings;
}

/// One wheel's speed a step later.
double Chassis::driven(double speed_m_s, double target_m_s, double dt_s) const {
  const bool slows_down = (target_m_s - speed_m_s) * speed_m_s < 0.0;
  const double limit_m_s2 =
      slows_down ? settings_.wheel_deceleration_max_m_s2 : settings_.wheel_acceleration_max_m_s2;
  return approach(speed_m_s, target_m_s, limit_m_s2 * dt_s);
}

void Chassis::drive(const WheelSpeeds& target, double dt_s) {
  wheels_.left_m_s = driven(wheels_.left_m_s, target.left_m_s, dt_s);
  wheels_.right_m_s = driven(wheels_.right_m_s, target.right_m_s, dt_s);
  move(dt_s);
}

void Chassis::coast(double dt_s) {
  const double step = settings_.coast_deceleration_m_s2 * dt_s;
  wheels_.left_m_s = approach(wheels_.left_m_s, 0.0, step);
  wheels_.right_m_s = approach(wheels_.right_m_s, 0.0, step);
  move(dt_s);
}

void Chassis::block(bool left, bool right) {
  blocked_left_ = left;
  blocked_right_ = right;
}

double Chassis::true_speed_m_s() const {
  return 0.5 * (wheels_.left_m_s * (1.0 + settings_.left_scale_error) +
                wheels_.right_m_s * (1.0 + settings_.right_scale_error));
}

double Chassis::true_yaw_rate_rad_s() const {
  return (wheels_.right_m_s * (1.0 + settings_.right_scale_error) -
          wheels_.left_m_s * (1.0 + settings_.left_scale_error)) /
         (settings_.true_track_m * settings_.track_scale);
}

void Chassis::move(double dt_s) {
  if (blocked_left_) wheels_.left_m_s = 0.0;
  if (blocked_right_) wheels_.right_m_s = 0.0;
  if (wheels_.left_m_s == 0.0 && wheels_.right_m_s == 0.0) return;

  const double left_m = wheels_.left_m_s * dt_s;
  const double right_m = wheels_.right_m_s * dt_s;
  left_travel_m_ += left_m;
  right_travel_m_ += right_m;
  add_arc(odometry_, 0.5 * (left_m + right_m), (right_m - left_m) / settings_.effective_track_m);

  // A random walk whose variance grows with the travelled distance does not depend on the step.
  const double root_travel = std::sqrt(0.5 * (std::abs(left_m) + std::abs(right_m)));
  const double drift_m = settings_.drift_per_sqrt_m * root_travel * gaussian_(random_);
  const double drift_rad = settings_.heading_drift_rad_per_sqrt_m * root_travel * gaussian_(random_);
  add_arc(true_pose_, true_speed_m_s() * dt_s + drift_m, true_yaw_rate_rad_s() * dt_s + drift_rad);
}

}  // namespace heel::sim
