// New values for single keys of a running daemon (`heel set`), checked as those of a file, and the
// differences between two configurations.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "config/config_load.h"

namespace heel {

/// A key's new value, not checked yet.
struct ConfigAssignment {
  std::string key;
  std::variant<bool, std::int64_t, double, std::string> value;
};

/// `current` with the new values. Each key must be one that can be set (ConfigKey::can_be_set) to a value
/// that a file could give it; a limit must not be looser than in `file`, the configuration as its file has
/// it. Throws ConfigError with every reason why not, one line each: "gate.v_max_m_s: 'fast' (expected a
/// number 0…1.2 m/s)".
Config with_assignments(const Config& current, const Config& file,
                        std::span<const ConfigAssignment> assignments);

/// A key whose value differs; the values as TOML writes them.
struct ConfigChange {
  std::string key;
  std::string before;
  std::string after;
  bool operator==(const ConfigChange&) const = default;
};

/// In the order of config_keys().
std::vector<ConfigChange> changes_between(const Config& before, const Config& after);

}  // namespace heel
