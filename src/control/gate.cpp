#include "control/gate.h"

#include <algorithm>
#include <cmath>

namespace heel {
namespace {

struct Velocity {
  double v_m_s = 0.0;
  double yaw_rate_rad_s = 0.0;
};

bool finite(const VelocityCommand& command) {
  return std::isfinite(command.v_m_s) && std::isfinite(command.yaw_rate_rad_s);
}

/// `value` clamped to [low, high]; sets the bit when that changes it.
double clamped(double value, double low, double high, GateLimit bit, unsigned& limited_by) {
  const double result = std::clamp(value, low, high);
  if (result != value) limited_by |= bit;
  return result;
}

/// From `from` towards `to`, by at most `speed_up_step` away from zero and `slow_down_step` towards it; a
/// change of sign stops at zero first.
double slewed(double from, double to, double speed_up_step, double slow_down_step) {
  const double sign = from < 0.0 || (from == 0.0 && to < 0.0) ? -1.0 : 1.0;
  const double now = sign * from;  // ≥ 0
  const double goal = std::max(sign * to, 0.0);
  return sign * std::clamp(goal, std::max(now - slow_down_step, 0.0), now + speed_up_step);
}

/// The largest speed from which half of `deceleration_m_s2` stops the robot `nearest_m` short.
double approach_limit(double range_m, double nearest_m, double deceleration_m_s2) {
  if (!(range_m > nearest_m) || !(deceleration_m_s2 > 0.0)) return 0.0;
  return std::sqrt(deceleration_m_s2 * (range_m - nearest_m));
}

/// The speed by which the arc ahead is judged. A robot that is only just moving while it turns would drive an
/// arc of some centimetres, and meet nothing on it: it will be faster before it is round.
double on_an_arc(double v_m_s) {
  constexpr double kLeast_m_s = 0.2;
  return v_m_s == 0.0 ? 0.0 : std::copysign(std::max(std::abs(v_m_s), kLeast_m_s), v_m_s);
}

Velocity velocity_at(const VelocityCommand& previous, TimeNs now_ns, const GateConfig& limits) {
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
  Velocity goal{wanted.v_m_s, wanted.yaw_rate_rad_s};
  if (style == StopStyle::ComeToRest) {
    goal = {};
  } else if (!finite(wanted)) {
    limited_by |= kGateNotFinite;
    goal = {};
  } else if (now_ns > wanted.t_expires_ns) {
    limited_by |= kGateAge;
    goal = {};
  }
  goal.v_m_s = clamped(goal.v_m_s, -limits.v_max_m_s, limits.v_max_m_s, kGateSpeed, limited_by);
  goal.yaw_rate_rad_s = clamped(goal.yaw_rate_rad_s, -limits.yaw_rate_max_rad_s, limits.yaw_rate_max_rad_s,
                                kGateSpeed, limited_by);
  // An unknown deceleration (NaN) permits no motion.
  const double brakes_m_s2 = std::min(clearances.deceleration_m_s2, limits.deceleration_m_s2);
  const double person_limit_m_s = approach_limit(clearances.person_m, limits.separation_m, brakes_m_s2);
  goal.v_m_s = clamped(goal.v_m_s, -limits.v_max_m_s, person_limit_m_s, kGateSeparation, limited_by);
  // Two arcs must be free: the one to drive, and the one that is driven until the velocity has changed.
  const Velocity now = velocity_at(previous, now_ns, limits);
  const Way wanted_way =
      clearances.obstacles.way(on_an_arc(goal.v_m_s), goal.yaw_rate_rad_s, limits.clearance_m);
  const Way present_way =
      clearances.obstacles.way(on_an_arc(now.v_m_s), now.yaw_rate_rad_s, limits.clearance_m);
  result.free_distance_m = std::min(wanted_way.free_m, present_way.free_m);
  const double obstacle_limit_m_s =
      approach_limit(std::min(wanted_way.room_m, present_way.room_m), 0.0, brakes_m_s2);
  goal.v_m_s = clamped(goal.v_m_s, -obstacle_limit_m_s, obstacle_limit_m_s, kGateObstacle, limited_by);
  const bool obstacle_holds = (limited_by & kGateObstacle) != 0 && obstacle_limit_m_s < kHeld_m_s;

  const bool expired = now_ns > previous.t_expires_ns;  // the first command after a gap is zero
  const TimeNs gap_ns = expired ? 0 : std::clamp<TimeNs>(now_ns - previous.t_issued_ns, 0, kLongestSlew_ns);
  const double dt_s = seconds_from_ns(gap_ns);
  out.v_m_s = slewed(now.v_m_s, goal.v_m_s, limits.acceleration_m_s2 * dt_s, limits.deceleration_m_s2 * dt_s);
  const double yaw_step = limits.yaw_acceleration_rad_s2 * dt_s;
  out.yaw_rate_rad_s =
      std::clamp(goal.yaw_rate_rad_s, now.yaw_rate_rad_s - yaw_step, now.yaw_rate_rad_s + yaw_step);
  if (out.v_m_s != goal.v_m_s || out.yaw_rate_rad_s != goal.yaw_rate_rad_s) limited_by |= kGateAcceleration;
  out.limited_by = static_cast<std::uint8_t>(limited_by);
  // A robot that drives backwards gives way: nothing holds it. Near the person a law may want no speed by
  // itself; the gate would allow none.
  if (style == StopStyle::Go && std::abs(out.v_m_s) < kHeld_m_s) {
    const bool person_holds = person_limit_m_s < kHeld_m_s && out.v_m_s >= 0.0;
    result.hold = person_holds ? Hold::PersonTooNear : obstacle_holds ? Hold::ObstacleAhead : Hold::None;
  }
  return result;
}

}  // namespace heel
