// What the robot does now, and why, as one sentence for the status and the log.
#pragma once

#include <string>

#include "heel/flow.h"

namespace heel {

/// "following", "held: …", "searching: …" or "at rest: …", and what an operator can do about it.
std::string state_sentence(const TickRecord& tick);

/// What the pictures show wrong, and what people can do about it; empty: nothing is wrong.
std::string picture_sentence(PictureFault fault);

}  // namespace heel
