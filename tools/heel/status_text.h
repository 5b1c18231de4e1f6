// The status of heeld for people: docs/operator.md has its fields.
#pragma once

#include <string>

#include "operator_client.h"

namespace heel::cli {

/// The state in capital letters and its sentence, then a line each about robot, camera, target, limits and
/// what was set.
std::string status_text(const Json& status);

/// One line: state, sentence, speed, person, battery.
std::string watch_text(const Json& status);

}  // namespace heel::cli
