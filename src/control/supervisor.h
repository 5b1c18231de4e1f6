// The supervisor: a table from conditions to the reason why the robot is at rest. The first row that applies
// counts.
#pragma once

#include <span>

#include "control/conditions.h"
#include "heel/flow.h"

namespace heel {

enum class StopStyle : std::uint8_t {
  Go,          ///< not stopping
  ComeToRest,  ///< within the deceleration limits
  AtOnce,      ///< zero on the wire now; the robot's controller brakes
};

struct SupervisorRow {
  Condition condition;
  StopReason reason;
  StopStyle style;
};

struct Verdict {
  StopReason reason = StopReason::None;
  StopStyle style = StopStyle::Go;
};

/// Highest priority first.
std::span<const SupervisorRow> supervisor_table();

/// The first row whose condition holds; following when none does.
Verdict supervise(Conditions conditions);

}  // namespace heel
