// The table of all configuration keys. The parser (config_reader), the example file and the manual
// (config_text) are made from it. Default values stand in src/core/config.h and are read from there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/config.h"

namespace heel {

/// Where a key's value is stored; the alternative is also the type of the value.
using ConfigField =
    std::variant<bool* (*)(Config&), int* (*)(Config&), double* (*)(Config&), std::string* (*)(Config&),
                 std::vector<std::string>* (*)(Config&)>;  // the last one: paths or names

/// What a text value holds.
enum class ConfigText : std::uint8_t {
  Choice,   ///< one of `choices`
  Path,     ///< a file or folder; relative to the configuration file's folder
  Address,  ///< SCHEME:REST; a path after v4l2:, file:, serial: or pty: is relative as for Path
  Listen,   ///< IP:PORT to listen at; empty: none
  Name,     ///< of a host
  Broker,   ///< tcp://HOST:PORT or ssl://HOST:PORT; empty: none
  Topic,    ///< of MQTT, as text that no broker refuses
  Text,     ///< a line of any text
};

enum class Reload : std::uint8_t {
  No,   ///< needs a restart; SIGHUP refuses a file that changes it
  Yes,  ///< applied at a tick boundary
};

/// Which values of a key are safer. `heel set` makes a running daemon safer than its file, never less safe.
enum class Tighter : std::uint8_t {
  None,     ///< no limit: any value in range
  Smaller,  ///< at most the file's value; of two flags, false is the smaller one
  Larger,   ///< at least the file's value
  Neither,  ///< a limit of which both a smaller and a larger value can be the less safe one: only the file
            ///< sets it
};

struct ConfigKey {
  std::string_view section;
  std::string_view name;
  ConfigField field;
  std::string_view unit;  ///< empty: none
  double min = 0.0;       ///< numbers: smallest and largest allowed; a list: its length
  double max = 0.0;
  ConfigText text = ConfigText::Choice;
  std::string_view choices;  ///< "a|b|c"
  Reload reload = Reload::No;
  Tighter tighter = Tighter::None;
  std::string_view effect;  ///< one or a few sentences

  /// `heel set` may change it.
  bool can_be_set() const { return reload == Reload::Yes && tighter != Tighter::Neither; }
  std::string full_name() const { return std::string(section) + "." + std::string(name); }
};

struct ConfigSection {
  std::string_view name;
  std::string_view about;
};

/// A condition on the values of two keys.
struct ConfigRelation {
  std::string_view key;  ///< the key that an error names
  bool (*holds)(const Config&);
  std::string_view requirement;  ///< on the value of `key`, e.g. "must be larger than vision.distance_min_m"
  bool lists_values = false;     ///< the requirement is the list of the only values
};

std::span<const ConfigSection> config_sections();
std::span<const ConfigKey> config_keys();
/// Its index in config_keys().
std::optional<std::size_t> index_of_key(std::string_view full_name);
std::span<const ConfigRelation> config_relations();

/// A key of an earlier version. A file that still sets it is refused with the reason.
struct RemovedConfigKey {
  std::string_view full_name;
  std::string_view reason;  ///< what does its work now
};
std::span<const RemovedConfigKey> removed_config_keys();

}  // namespace heel
