// Reads a configuration file: TOML, checked against the table of keys. All that is wrong with a file is said
// at once, a line each: "heel.toml:12:8: control.gain_yaw_1_s: 'fast' is not …".
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/config.h"
#include "heel/error.h"

namespace heel {

/// Every complaint about a file; what() holds them all, a line each.
class ConfigError : public Error {
 public:
  explicit ConfigError(std::vector<std::string> lines);
  const std::vector<std::string>& lines() const { return lines_; }

 private:
  std::vector<std::string> lines_;
};

struct LoadedConfig {
  std::string file;
  Config config;
  std::vector<int> line_of;  ///< in the order of config_keys(): the line that sets the key; 0: default
};

/// Throws ConfigError. Relative paths in the file are resolved against the file's folder, defaults included.
LoadedConfig load_config(const std::string& path);
/// As load_config, from text; `file` is the name used in complaints and for its folder.
LoadedConfig parse_config(std::string_view text, const std::string& file);

/// Full names of keys whose values differ between the two but that cannot be reloaded.
std::vector<std::string> keys_needing_restart(const Config& before, const Config& after);

}  // namespace heel
