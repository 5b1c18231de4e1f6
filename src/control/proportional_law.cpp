#include "control/proportional_law.h"

#include <algorithm>
#include <cmath>

#include "control/distance_error.h"
#include "control/view_bounds.h"
#include "core/angles.h"

namespace heel {
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
  const YawRateBounds bounds =
      view_bounds(target, mount_, v_m_s, {}, gains_.bearing_max_rad, gains_.bearing_1_s);
  return {v_m_s, std::clamp(proportional_yaw_rate_rad_s(target), bounds.least_rad_s, bounds.most_rad_s)};
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

}  // namespace heel
