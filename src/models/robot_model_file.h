// The file of one robot model, config/robots/SUBCLASS.toml.
#pragma once

#include <string>
#include <string_view>

#include "core/robot_model.h"

namespace heel {

/// Throws heel::Error, which names `file`, the key and what was expected.
RobotModel parse_robot_model(std::string_view text, const std::string& file);

}  // namespace heel
