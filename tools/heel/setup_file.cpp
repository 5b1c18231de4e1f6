#include "setup_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "config/config_edit.h"
#include "config/config_table.h"
#include "files/atomic_file.h"
#include "heel/error.h"
#include "toml/toml_file.h"

namespace heel::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kIntroduction =
    "# Configuration of heeld, begun by `heel setup`. heel.toml(5) lists every key; those that are not here\n"
    "# have their default values. Relative paths start at the folder of this file.\n";
constexpr const char* kWhatItIs = "a configuration of heeld";

}  // namespace

void require_folder_takes(const std::string& file) {
  const fs::path folder = fs::absolute(file).lexically_normal().parent_path();
  if (access(folder.c_str(), W_OK | X_OK) != 0)
    throw Error(fmt::format("{}: its folder cannot be written: {} (expected a user who may; sudo?)", file,
                            std::strerror(errno)));
}

SetupFile::SetupFile(const std::string& path) : path_(fs::absolute(path).lexically_normal().string()) {
  if (!fs::exists(path_)) {
    write_file_atomically(path_, kIntroduction);
  } else {
    require_folder_takes(path_);
  }
  loaded_ = load_config(path_);
}

bool SetupFile::sets(const std::string& key) const {
  return loaded_.line_of[*index_of_key(key)] != 0;
}

std::string SetupFile::beside(const std::string& name) const {
  return (fs::path(path_).parent_path() / name).string();
}

void SetupFile::write(const Config& wanted) {
  const std::vector<ConfigChange> changes = changes_between(loaded_.config, wanted);
  if (changes.empty()) return;
  const std::string edited = edited_config_text(read_toml_text(path_, kWhatItIs), path_, changes);
  write_file_atomically(path_, edited);
  loaded_ = parse_config(edited, path_);
}

std::string address_from_here(const std::string& address) {
  const std::size_t colon = address.find(':');
  const std::string kind = address.substr(0, colon);
  if (kind != "v4l2" && kind != "file" && kind != "serial" && kind != "pty") return address;
  return kind + ":" + fs::absolute(address.substr(colon + 1)).lexically_normal().string();
}

}  // namespace heel::cli
