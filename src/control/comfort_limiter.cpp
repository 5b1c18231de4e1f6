#include "control/comfort_limiter.h"

#include <algorithm>
#include <cmath>

#include "control/gate.h"

namespace heel {
namespace {

/// The largest acceleration from which a jerk of −`jerk` a step ends at the wanted velocity, `missing` away.
/// With steps of dt: m steps of acceleration m j dt … j dt change the velocity by j dt² m (m + 1) / 2.
double landing_acceleration(double missing, double jerk, double dt_s) {
  const double step = jerk * dt_s * dt_s;
  const double steps = std::sqrt(0.25 + 2.0 * missing / step) - 0.5;
  return std::min(steps * jerk * dt_s, missing / dt_s);
}

}  // namespace

void ComfortLimiter::reconfigure(const Config& config) {
  const ControlConfig& control = config.control;
  const GateConfig& gate = config.gate;
  const double yaw_rad_s2 = std::min(control.yaw_acceleration_rad_s2, gate.yaw_acceleration_rad_s2);
  translation_.limits = {std::min(control.acceleration_m_s2, gate.acceleration_m_s2),
                         std::min(control.deceleration_m_s2, gate.deceleration_m_s2), control.jerk_m_s3};
  rotation_.limits = {yaw_rad_s2, yaw_rad_s2, control.yaw_jerk_rad_s3};
}

double ComfortLimiter::Axis::step(double wanted, double from, double dt_s) {
  if (from != velocity) acceleration = 0.0;  // the gate, or a stop, changed the last velocity
  velocity = from;
  if (dt_s <= 0.0) return velocity;
  const double missing = wanted - from;
  const bool away_from_zero = missing * from >= 0.0;
  const double limit = away_from_zero ? limits.speed_up : limits.slow_down;
  const double goal =
      std::copysign(std::min(limit, landing_acceleration(std::abs(missing), limits.jerk, dt_s)), missing);
  acceleration += std::clamp(goal - acceleration, -limits.jerk * dt_s, limits.jerk * dt_s);
  velocity = from + acceleration * dt_s;
  return velocity;
}

WantedVelocity ComfortLimiter::limited(const WantedVelocity& wanted, const VelocityCommand& previous,
                                       TimeNs now_ns) {
  if (!std::isfinite(wanted.v_m_s) || !std::isfinite(wanted.yaw_rate_rad_s)) return wanted;
  const bool expired = now_ns > previous.t_expires_ns;
  const TimeNs gap_ns = expired ? 0 : std::clamp<TimeNs>(now_ns - previous.t_issued_ns, 0, kLongestSlew_ns);
  const double dt_s = seconds_from_ns(gap_ns);
  WantedVelocity out = wanted;
  out.v_m_s = translation_.step(wanted.v_m_s, expired ? 0.0 : previous.v_m_s, dt_s);
  out.yaw_rate_rad_s = rotation_.step(wanted.yaw_rate_rad_s, expired ? 0.0 : previous.yaw_rate_rad_s, dt_s);
  return out;
}

}  // namespace heel
