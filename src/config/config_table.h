// The one table of configuration keys. The parser (config_load), the example file and the manual table
// (config_text) are all made from it. Defaults stand in src/core/config.h and are read from there.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "core/config.h"

namespace heel {

/// Where a key's value lives; the alternative is also its type.
using ConfigField =
    std::variant<bool* (*)(Config&), int* (*)(Config&), double* (*)(Config&), std::string* (*)(Config&)>;

/// What a text value holds.
enum class ConfigText : std::uint8_t {
  Choice,   ///< one of `choices`
  Path,     ///< a file or folder; relative to the configuration file's folder
  Address,  ///< SCHEME:REST; a path after v4l2:, file:, serial: or pty: is taken as for Path
};

enum class Reload : std::uint8_t {
  No,   ///< needs a restart; SIGHUP refuses a file that changes it
  Yes,  ///< taken over at a tick boundary
};

struct ConfigKey {
  std::string_view section;
  std::string_view name;
  ConfigField field;
  std::string_view unit;  ///< empty: none
  double min = 0.0;       ///< numbers: smallest and largest allowed
  double max = 0.0;
  ConfigText text = ConfigText::Choice;
  std::string_view choices;  ///< "a|b|c"
  Reload reload = Reload::No;
  std::string_view effect;  ///< one sentence

  std::string full_name() const { return std::string(section) + "." + std::string(name); }
};

struct ConfigSection {
  std::string_view name;
  std::string_view about;
};

std::span<const ConfigSection> config_sections();
std::span<const ConfigKey> config_keys();

/// A key's value as it is written in TOML: 0.7, true, "auto".
std::string toml_value(const ConfigKey& key, const Config& config);
/// "0…10 1/s", "true or false", "stop or loop", "a path": what a value of this key must be.
std::string expected_value(const ConfigKey& key);
/// "bool", "int", "real", "choice", "path", "address".
std::string_view type_name(const ConfigKey& key);

/// Holds for every key, or says in one line what two keys together get wrong; `key` is where to complain.
struct ConfigRelation {
  std::string_view key;
  bool (*holds)(const Config&);
  std::string_view requirement;
};
std::span<const ConfigRelation> config_relations();

}  // namespace heel
