// heeld --check: a configuration and everything it refers to, without touching camera or robot.
#pragma once

#include <string>

namespace heel {

/// Prints every value with its origin, then what the referenced files hold. Throws ConfigError or Error.
void check_configuration(const std::string& path);

/// One line about the template: how many features, how well spread, how alike.
struct TemplateVerdict;
std::string verdict_line(const TemplateVerdict& verdict);

}  // namespace heel
