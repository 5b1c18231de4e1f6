// heeld --check: a configuration and the files it refers to, without access to camera or robot.
#pragma once

#include <string>

namespace heel {

/// Prints every value with its origin, then what the referenced files hold. Throws ConfigError or Error.
void check_configuration(const std::string& path);

}  // namespace heel
