// A session event with the names of the robot in it, for the log.
#pragma once

#include <span>
#include <string_view>

#include "heel/flow.h"
#include "robot/session_event.h"

namespace heel {

/// Copies the event's line into `out`, cut to fit and ended by a zero: "{class}", "{subclass}" and "{model}"
/// are replaced by the robot's, "{text}" by `heard`, "{}" stays for the event's value. Does not allocate.
void write_event_text(const SessionEvent& event, const RobotKind& kind, std::string_view heard,
                      std::span<char> out);

}  // namespace heel
