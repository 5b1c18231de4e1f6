// Values of configuration keys as text: how TOML writes them, and what an error or the manual says of their
// type and range.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "config/config_table.h"

namespace heel {

/// A key's value as TOML writes it: 0.7, true, "auto".
std::string toml_value(const ConfigKey& key, const Config& config);

/// A number as it is, true as 1 and false as 0; 0 for text.
double number_value(const ConfigKey& key, const Config& config);

/// What a value of this key must be: "a number 0…10 1/s", "true or false", "stop or loop", "a path in
/// quotes".
std::string expected_value(const ConfigKey& key);

/// The same without words and unit, for a table: "0…10", "64…4096, whole", "true, false", "path".
std::string value_range(const ConfigKey& key);

/// The values that `heel set` may give the key of a running daemon: "no", "yes", or the direction from the
/// file's value, "smaller" or "larger".
std::string_view settable_values(const ConfigKey& key);

/// "bool", "int", "real", "choice", "path", "address", "listen", "broker", "topic", "text",
/// "paths", "names".
std::string_view type_name(const ConfigKey& key);

/// The parts of "a|b|c".
std::vector<std::string_view> split_choices(std::string_view choices);

}  // namespace heel
