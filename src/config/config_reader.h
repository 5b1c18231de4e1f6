// Reads a parsed TOML file into a Config, by the table of keys, and collects every error in it.
#pragma once

#include <toml++/toml.h>

#include <string>
#include <string_view>
#include <vector>

#include "config/config_load.h"

namespace heel {

class ConfigReader {
 public:
  /// `out` must have its file name and default values.
  explicit ConfigReader(LoadedConfig& out);

  /// Fills in the values and their lines. Throws ConfigError with all errors, in the order of the file.
  void read(const toml::table& root);

 private:
  struct PlacedError {
    toml::source_position at;
    std::string line;
  };

  void read_section(std::string_view section, const toml::table& table);
  void check_relations();
  void add_error(toml::source_position at, const std::string& key, const std::string& what);
  void throw_errors();

  LoadedConfig& out_;
  std::vector<PlacedError> errors_;
};

}  // namespace heel
