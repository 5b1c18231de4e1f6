// Reads a configuration file: TOML, checked against the table of keys. Every error in a file is reported at
// once, one line each: "heel.toml:12:8: control.gain_yaw_1_s: 'fast' (expected a number 0…10 1/s)".
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/config.h"
#include "heel/error.h"

namespace heel {

/// All errors of a file; what() holds all of them, one line each.
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

/// Throws ConfigError, or Error when the file cannot be read. Relative paths, those of default values
/// included, start at the file's folder.
LoadedConfig load_config(const std::string& path);
/// The same from text; `file` stands for the file's name in errors and for its folder.
LoadedConfig parse_config(std::string_view text, const std::string& file);

/// The full names of keys that differ between the two and cannot be reloaded.
std::vector<std::string> keys_needing_restart(const Config& before, const Config& after);

}  // namespace heel
