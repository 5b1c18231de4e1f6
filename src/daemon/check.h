// heeld --check: a configuration and the files it refers to, without access to camera or robot.
#pragma once

#include <string>

namespace heel {

/// Prints every value with its origin, then what the referenced files hold. Throws ConfigError or Error.
void check_configuration(const std::string& path);

struct CheckAnswer {
  bool valid = false;
  std::string json;  ///< one object
};

/// The same for programs: {"file", "valid", "errors": lines}, and of a valid configuration "keys" (each with
/// its "value" and "line"; 0: default), "camera", "warnings" and "templates" (lines), "page" (who can reach
/// it) and "mqtt" (where the status goes).
CheckAnswer check_configuration_as_json(const std::string& path);

}  // namespace heel
