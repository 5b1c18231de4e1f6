// The text of config/robots/*.toml, put into the program by the build.
#pragma once

#include <span>
#include <string_view>

namespace heel {

struct EmbeddedFile {
  std::string_view name;  ///< for messages: "config/robots/p3at-sh.toml"
  std::string_view text;
};

/// In the order of src/models/CMakeLists.txt.
std::span<const EmbeddedFile> embedded_robot_files();

}  // namespace heel
