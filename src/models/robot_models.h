// The robots that heel can drive. Their files, config/robots/*.toml, are part of the program, so that it
// needs no installation to know them.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/robot_model.h"

namespace heel {

/// All of them, always in the same order; the first is the p3at-sh. The first call reads them: a program
/// that has real-time threads makes it before it starts them. Throws heel::Error when a file is wrong.
std::span<const RobotModel> robot_models();

/// Its index in robot_models(), upper and lower case alike. Does not allocate.
std::optional<std::size_t> index_of_model(std::string_view subclass);

/// Throws heel::Error, which lists the names, when there is no such model.
const RobotModel& robot_model(std::string_view subclass);

/// "p3at-sh, p3at, …".
std::string robot_model_names();

}  // namespace heel
