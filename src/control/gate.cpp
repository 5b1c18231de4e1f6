#include "control/gate.h"

#include <algorithm>
#include <cmath>

namespace heel {
namespace {

struct Motion {
  double v_m_s = 0.0;
  double yaw_rate_rad_s = 0.0;
};

bool finite(const VelocityCommand& command) {
  return std::isfinite(command.v_m_s) && std::isfinite(command.yaw_rate_rad_s);
}

/// `value` held to [low, high]; sets the bit when it had to be.
double bounded(double value, double low, double high, GateLimit bit, unsigned& limited_by) {
  const double result = std::clamp(value, low, high);
  if (result != value) limited_by |= bit;
  return result;
}

/// From `from` towards `to`, no faster than `gain_step` away from zero and `loss_step` towards it; a change
/// of sign stops at zero first.
double slewed(double from, double to, double gain_step, double loss_step) {
  const double sign = from < 0.0 || (from == 0.0 && to < 0.0) ? -1.0 : 1.0;
  const double now = sign * from;  // ≥ 0
  const double aim = std::max(sign * to, 0.0);
  return sign * std::clamp(aim, std::max(now - loss_step, 0.0), now + gain_step);
}

/// Fastest approach from which half the deceleration still stops at `nearest_m`.
double approach_limit(double range_m, double nearest_m, const GateConfig& limits) {
  if (!(range_m > nearest_m)) return 0.0;
  return std::sqrt(limits.deceleration_m_s2 * (range_m - nearest_m));
}

Motion moving_at(const VelocityCommand& previous, TimeNs now_ns, const GateConfig& limits) {
  if (!finite(previous) || now_ns > previous.t_expires_ns) return {};
  return {std::clamp(previous.v_m_s, -limits.v_max_m_s, limits.v_max_m_s),
          std::clamp(previous.yaw_rate_rad_s, -limits.yaw_rate_max_rad_s, limits.yaw_rate_max_rad_s)};
}

}  // namespace

GateResult apply_gate(const VelocityCommand& wanted, const VelocityCommand& previous, StopStyle style,
                      const Clearances& clearances, TimeNs now_ns, const GateConfig& limits) {
  GateResult result;
  VelocityCommand& out = result.command;
  out.t_issued_ns = now_ns;
  out.t_expires_ns = now_ns + ns_from_seconds(limits.command_lifetime_s);
  if (style == StopStyle::AtOnce) return result;

  unsigned limited_by = wanted.limited_by;
  Motion aim{wanted.v_m_s, wanted.yaw_rate_rad_s};
  if (style == StopStyle::ComeToRest) {
    aim = {};
  } else if (!finite(wanted)) {
    limited_by |= kGateNotFinite;
    aim = {};
  } else if (now_ns > wanted.t_expires_ns) {
    limited_by |= kGateAge;
    aim = {};
  }
  aim.v_m_s = bounded(aim.v_m_s, -limits.v_max_m_s, limits.v_max_m_s, kGateSpeed, limited_by);
  aim.yaw_rate_rad_s = bounded(aim.yaw_rate_rad_s, -limits.yaw_rate_max_rad_s, limits.yaw_rate_max_rad_s,
                               kGateSpeed, limited_by);
  aim.v_m_s =
      bounded(aim.v_m_s, -limits.v_max_m_s, approach_limit(clearances.person_m, limits.separation_m, limits),
              kGateSeparation, limited_by);
  // The way the robot is to take must be free, and so must the way it is on until it has changed over.
  const Motion now = moving_at(previous, now_ns, limits);
  result.free_distance_m = std::min(clearances.obstacles.free_distance_m(aim.v_m_s, aim.yaw_rate_rad_s),
                                    clearances.obstacles.free_distance_m(now.v_m_s, now.yaw_rate_rad_s));
  const double cautious_m_s = approach_limit(result.free_distance_m, limits.clearance_m, limits);
  aim.v_m_s = bounded(aim.v_m_s, -cautious_m_s, cautious_m_s, kGateObstacle, limited_by);

  const bool stale = now_ns > previous.t_expires_ns;  // after a gap the first command is zero
  const TimeNs gap_ns = stale ? 0 : std::clamp<TimeNs>(now_ns - previous.t_issued_ns, 0, kLongestSlew_ns);
  const double dt_s = seconds_from_ns(gap_ns);
  out.v_m_s = slewed(now.v_m_s, aim.v_m_s, limits.acceleration_m_s2 * dt_s, limits.deceleration_m_s2 * dt_s);
  const double yaw_step = limits.yaw_acceleration_rad_s2 * dt_s;
  out.yaw_rate_rad_s =
      std::clamp(aim.yaw_rate_rad_s, now.yaw_rate_rad_s - yaw_step, now.yaw_rate_rad_s + yaw_step);
  if (out.v_m_s != aim.v_m_s || out.yaw_rate_rad_s != aim.yaw_rate_rad_s) limited_by |= kGateAcceleration;
  out.limited_by = static_cast<std::uint8_t>(limited_by);
  return result;
}

}  // namespace heel
