// The configuration as text for people: the example file, the manual, and the listing of --check.
#pragma once

#include <string>

#include "config/config_load.h"

namespace heel {

/// config/heel.toml: every key with its default value, effect, unit and range.
std::string default_config_text();
/// docs/configuration.md: every key in Markdown tables.
std::string config_manual_text();
/// One line for each key: its name, its value, and where the value comes from.
std::string config_listing(const LoadedConfig& loaded);

/// Every key with its value, as TOML that parse_config() reads back as the same configuration.
std::string config_toml(const Config& config);

}  // namespace heel
