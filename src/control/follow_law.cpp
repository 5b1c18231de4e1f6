#include "control/follow_law.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/angles.h"

namespace heel {
namespace {

/// Zero inside the band, continuous outside.
double with_deadband(double error, double band) {
  if (std::abs(error) <= band) return 0.0;
  return error - std::copysign(band, error);
}

double speed(const TargetState& target, const ControlConfig& control) {
  const double v_m_s =
      control.gain_distance_1_s * with_deadband(target.goal_x_m, control.deadband_distance_m);
  return control.reverse ? v_m_s : std::max(v_m_s, 0.0);
}

double proportional_yaw_rate(const TargetState& target, const ControlConfig& control) {
  const double psi_rad = wrap_angle_rad(target.yaw_rad + control.setpoint_yaw_rad);
  return control.gain_lateral_rad_s_m * target.goal_y_m + control.gain_yaw_1_s * psi_rad;
}

/// The bounds on the yaw rate that keep the person's bearing within its limit.
double kept_in_view(double yaw_rate_rad_s, double v_m_s, const TargetState& target,
                    const ControlConfig& control, const CameraMount& mount) {
  constexpr double kLeastRange_m = 0.1;  // nearer, the bearing means nothing
  const double x_m = target.x_m - mount.x_m;
  const double y_m = target.y_m - mount.y_m;
  const double bearing_rad = std::atan2(y_m, x_m);
  const double passing_rad_s = v_m_s * std::sin(bearing_rad) / std::max(std::hypot(x_m, y_m), kLeastRange_m);
  const double least = passing_rad_s - control.bearing_gain_1_s * (control.bearing_max_rad - bearing_rad);
  const double most = passing_rad_s + control.bearing_gain_1_s * (control.bearing_max_rad + bearing_rad);
  return std::clamp(yaw_rate_rad_s, least, most);
}

}  // namespace

VelocityCommand follow(const TargetState& target, const ControlConfig& control, const CameraMount& mount,
                       TimeNs now_ns, double lifetime_s) {
  VelocityCommand wanted;
  wanted.t_issued_ns = now_ns;
  wanted.t_expires_ns = now_ns + ns_from_seconds(lifetime_s);
  if (!target.known) return wanted;
  wanted.v_m_s = speed(target, control);
  wanted.yaw_rate_rad_s =
      kept_in_view(proportional_yaw_rate(target, control), wanted.v_m_s, target, control, mount);
  return wanted;
}

}  // namespace heel
