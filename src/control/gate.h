// The last limits before the wire. Whatever the input is, the output is finite, within the speed limits,
// reachable from the previous command within the acceleration limits, and expires.
#pragma once

#include <limits>

#include "control/condition_table.h"
#include "control/sonar_obstacles.h"
#include "core/config.h"
#include "heel/flow.h"

namespace heel {

/// A gap between ticks that is longer than this allows no larger change of velocity.
inline constexpr TimeNs kLongestSlew_ns = 100 * kNsPerMs;
/// Slower than this, and not allowed to be faster, the robot counts as held.
inline constexpr double kHeld_m_s = 0.05;

/// What the robot must not come too near to, in this tick.
struct Clearances {
  double person_m = std::numeric_limits<double>::infinity();  ///< camera to back, when the person is ahead
  SonarObstacles obstacles;
  /// The deceleration that the robot is known to reach; the gate plans its stops with no more than that.
  double deceleration_m_s2 = std::numeric_limits<double>::infinity();
};

struct GateResult {
  VelocityCommand command;
  Hold hold = Hold::None;
  /// Bumper to the nearest echo in the way; infinite: none; NaN: not asked for, because the robot stops at
  /// once.
  double free_distance_m = std::numeric_limits<double>::quiet_NaN();
};

/// `previous` is the gate's last command. One that has expired, or none, counts as rest, and the first
/// command after it is zero.
GateResult apply_gate(const VelocityCommand& wanted, const VelocityCommand& previous, StopStyle style,
                      const Clearances& clearances, TimeNs now_ns, const GateConfig& limits);

}  // namespace heel
