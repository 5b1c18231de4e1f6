// Events as text for the log and events.log.
#pragma once

#include <spdlog/common.h>

#include <string>

#include "heel/flow.h"

namespace heel {

/// One line, e.g. "camera lost: v4l2:/dev/video0: the device has gone".
std::string event_text(const Event& event);

spdlog::level::level_enum event_level(EventKind kind);

/// The part of heel that the event is about: "camera", "robot" or "schedule".
const char* event_part(EventKind kind);

/// True for events that can occur at every frame or tick; they are logged at most once a second.
bool event_repeats(EventKind kind);

}  // namespace heel
