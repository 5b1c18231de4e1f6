#include "control/proportional_law.h"

#include <algorithm>
#include <cmath>

#include "core/angles.h"

namespace heel {
namespace {

/// Zero inside the band, continuous outside.
double with_deadband(double error, double band) {
  if (std::abs(error) <= band) return 0.0;
  return error - std::copysign(band, error);
}

/// How far behind the person the goal is, along the heading `psi_rad` to have there.
double distance_behind_m(const TargetState& target, double psi_rad) {
  return (target.x_m - target.goal_x_m) * std::cos(psi_rad) +
         (target.y_m - target.goal_y_m) * std::sin(psi_rad);
}

}  // namespace

ProportionalLaw::ProportionalLaw(const Config& config, YawGain yaw_gain) : yaw_gain_(yaw_gain) {
  reconfigure(config);
}

void ProportionalLaw::reconfigure(const Config& config) {
  const ControlConfig& control = config.control;
  gains_ = {.distance_1_s = control.gain_distance_1_s,
            .lateral_rad_s_m = control.gain_lateral_rad_s_m,
            .yaw_1_s = control.gain_yaw_1_s,
            .setpoint_yaw_rad = control.setpoint_yaw_rad,
            .deadband_distance_m = control.deadband_distance_m,
            .reverse = control.reverse,
            .bearing_max_rad = control.bearing_max_rad,
            .bearing_1_s = control.bearing_gain_1_s};
  mount_ = mount_of(config.camera);
}

WantedVelocity ProportionalLaw::velocity(const FollowInput& input) {
  const TargetState& target = input.target;
  if (!target.known) return {};
  const double v_m_s = speed_m_s(target);
  return {v_m_s, keep_in_view(proportional_yaw_rate_rad_s(target), v_m_s, target)};
}

double ProportionalLaw::speed_m_s(const TargetState& target) const {
  const double v_m_s = gains_.distance_1_s * with_deadband(target.goal_x_m, gains_.deadband_distance_m);
  return gains_.reverse ? v_m_s : std::max(v_m_s, 0.0);
}

double ProportionalLaw::proportional_yaw_rate_rad_s(const TargetState& target) const {
  const double psi_rad = wrap_angle_rad(target.travel_yaw_rad + gains_.setpoint_yaw_rad);
  const double yaw_1_s = yaw_gain_ == YawGain::CancelsYaw
                             ? gains_.lateral_rad_s_m * distance_behind_m(target, psi_rad)
                             : gains_.yaw_1_s;
  return gains_.lateral_rad_s_m * target.goal_y_m + yaw_1_s * psi_rad;
}

/// The yaw rate, within the bounds that keep the person's bearing within its limit.
double ProportionalLaw::keep_in_view(double yaw_rate_rad_s, double v_m_s, const TargetState& target) const {
  constexpr double kLeastRange_m = 0.1;  // a bearing at a smaller range is noise
  const double x_m = target.x_m - mount_.x_m;
  const double y_m = target.y_m - mount_.y_m;
  const double bearing_rad = std::atan2(y_m, x_m);
  const double passing_rad_s = v_m_s * std::sin(bearing_rad) / std::max(std::hypot(x_m, y_m), kLeastRange_m);
  const double least = passing_rad_s - gains_.bearing_1_s * (gains_.bearing_max_rad - bearing_rad);
  const double most = passing_rad_s + gains_.bearing_1_s * (gains_.bearing_max_rad + bearing_rad);
  return std::clamp(yaw_rate_rad_s, least, most);
}

}  // namespace heel
