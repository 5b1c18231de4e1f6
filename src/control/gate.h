// The last look before the wire. Whatever comes in, what goes out is finite, within the speed limits, within
// reach of the command before it at the acceleration limits, and expires.
#pragma once

#include "control/supervisor.h"
#include "heel/config.h"
#include "heel/flow.h"

namespace heel {

/// `previous` is what the gate let through last; one that has expired, or none, counts as rest, and the first
/// command after it is zero. Longer gaps between ticks than `kLongestSlew_ns` do not allow larger steps.
inline constexpr TimeNs kLongestSlew_ns = 100 * kNsPerMs;

/// `range_m` is from the camera to the person's back, ahead of it; infinite when not known.
VelocityCommand pass_gate(const VelocityCommand& wanted, const VelocityCommand& previous, StopStyle style,
                          double range_m, TimeNs now_ns, const GateConfig& limits);

}  // namespace heel
