// The configuration file that `heel setup` writes into, step by step.
#pragma once

#include <string>

#include "config/config_load.h"

namespace heel::cli {

class SetupFile {
 public:
  /// A file that is missing is made, with nothing set in it. Throws heel::Error naming what cannot be read or
  /// written.
  explicit SetupFile(const std::string& path);

  const std::string& path() const { return path_; }
  const Config& config() const { return loaded_.config; }
  /// Whether a line of the file sets the key: the value is no default.
  bool sets(const std::string& key) const;
  /// A file in the same folder.
  std::string beside(const std::string& name) const;

  /// Writes the values that differ; all else, comments and order included, stays. At every moment the file is
  /// whole.
  void write(const Config& wanted);

 private:
  std::string path_;
  LoadedConfig loaded_;
};

/// Throws heel::Error naming the file unless its folder is there and files can be made in it. People are not
/// asked, and nothing is moved, for a result that cannot be kept.
void require_folder_takes(const std::string& file);

/// The path of a camera's or robot's address as it is meant here, and not in the folder of a file.
std::string address_from_here(const std::string& address);

}  // namespace heel::cli
