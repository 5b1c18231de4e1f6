// The configuration written for people: the example file, the manual's table, the listing of --check.
#pragma once

#include <string>

#include "config/config_load.h"

namespace heel {

/// config/heel.toml: every key with its default, effect, unit and range.
std::string default_config_text();
/// config/README.md: every key as a Markdown table.
std::string config_manual_text();
/// A line a key: name, value in force, and where it comes from.
std::string config_listing(const LoadedConfig& loaded);

}  // namespace heel
