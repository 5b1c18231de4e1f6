// The man page of the configuration file, made from the table of keys.
#pragma once

#include <string>

namespace heel::commandline {

/// heel.toml(5).
std::string config_man_page();

}  // namespace heel::commandline
