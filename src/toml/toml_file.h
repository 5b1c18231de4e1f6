// Parsing TOML, and error messages that name the place. Every message about a TOML file is one line:
// "FILE:LINE:COLUMN: KEY: what was found (expected …)".
#pragma once

#include <toml++/toml.h>

#include <string>
#include <string_view>
#include <vector>

namespace heel {

/// The file as text. Throws heel::Error "PATH: cannot read: WHY (expected `expected`)".
std::string read_toml_text(const std::string& path, const std::string& expected);

/// Throws heel::Error for a syntax error. `file` is the name used in the message.
toml::table parse_toml(std::string_view text, const std::string& file);

/// "FILE:LINE:COLUMN: KEY: FOUND"; line and column are left out when `at` has none, the file when it is
/// empty.
std::string toml_message(const std::string& file, toml::source_position at, const std::string& key,
                         const std::string& found);

/// A value as the file has it: 'fast', -1, true; "a list" or "a section" for those.
std::string toml_value_text(const toml::node& node);

/// "; did you mean NAME?" with the candidate nearest to `name`; empty when none is near.
std::string nearest_name_question(std::string_view name, const std::vector<std::string>& candidates);

}  // namespace heel
