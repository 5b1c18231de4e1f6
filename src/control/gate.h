// The last look before the wire. Whatever comes in, what goes out is finite, within the speed limits, within
// reach of the command before it at the acceleration limits, and expires.
#pragma once

#include <limits>

#include "control/sonar_obstacles.h"
#include "control/supervisor.h"
#include "core/config.h"
#include "heel/flow.h"

namespace heel {

/// `previous` is what the gate let through last; one that has expired, or none, counts as rest, and the first
/// command after it is zero. Longer gaps between ticks than `kLongestSlew_ns` do not allow larger steps.
inline constexpr TimeNs kLongestSlew_ns = 100 * kNsPerMs;

/// What the robot must keep away from, now.
struct Clearances {
  double person_m = std::numeric_limits<double>::infinity();  ///< camera to back, when the person is ahead
  SonarObstacles obstacles;
};

struct GateResult {
  VelocityCommand command;
  /// Bumper to the nearest echo in the way; infinite: none; NaN: not asked for, because the robot stops at
  /// once.
  double free_distance_m = std::numeric_limits<double>::quiet_NaN();
};

GateResult apply_gate(const VelocityCommand& wanted, const VelocityCommand& previous, StopStyle style,
                      const Clearances& clearances, TimeNs now_ns, const GateConfig& limits);

}  // namespace heel
