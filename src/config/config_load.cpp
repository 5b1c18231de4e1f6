#include "config/config_load.h"

#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "config/config_reader.h"
#include "config/config_table.h"
#include "config/config_value.h"
#include "toml/toml_file.h"

namespace heel {
namespace {

namespace fs = std::filesystem;

std::string resolved_path(const std::string& path, const fs::path& folder) {
  if (path.empty() || fs::path(path).is_absolute()) return path;
  return (folder / path).lexically_normal().string();
}

/// The path part of v4l2:, file:, serial: and pty: addresses is relative to the folder.
std::string resolved_address(const std::string& address, const fs::path& folder) {
  const auto colon = address.find(':');
  const std::string scheme = address.substr(0, colon);
  const bool holds_path = scheme == "v4l2" || scheme == "file" || scheme == "serial" || scheme == "pty";
  if (!holds_path) return address;
  return scheme + ":" + resolved_path(address.substr(colon + 1), folder);
}

void resolve_paths(Config& config, const fs::path& folder) {
  for (const auto& key : config_keys()) {
    auto* const* list = std::get_if<std::vector<std::string>* (*)(Config&)>(&key.field);
    if (list && key.text == ConfigText::Path)
      for (std::string& path : *(*list)(config)) path = resolved_path(path, folder);
    auto* const* field = std::get_if<std::string* (*)(Config&)>(&key.field);
    if (!field) continue;
    std::string& value = *(*field)(config);
    if (key.text == ConfigText::Path) value = resolved_path(value, folder);
    if (key.text == ConfigText::Address) value = resolved_address(value, folder);
  }
}

}  // namespace

ConfigError::ConfigError(std::vector<std::string> lines)
    : Error(fmt::format("{}", fmt::join(lines, "\n"))), lines_(std::move(lines)) {}

LoadedConfig parse_config(std::string_view text, const std::string& file) {
  LoadedConfig loaded;
  loaded.file = file;
  toml::table table;
  try {
    table = parse_toml(text, file);
  } catch (const Error& error) {
    throw ConfigError({error.what()});
  }
  ConfigReader(loaded).read(table);
  resolve_paths(loaded.config, fs::path(file).parent_path());
  return loaded;
}

LoadedConfig load_config(const std::string& path) {
  return parse_config(read_toml_text(path, "a configuration file such as heel.toml"), path);
}

std::vector<std::string> keys_needing_restart(const Config& before, const Config& after) {
  std::vector<std::string> names;
  for (const auto& key : config_keys()) {
    if (key.reload == Reload::No && toml_value(key, before) != toml_value(key, after)) {
      names.push_back(key.full_name());
    }
  }
  return names;
}

}  // namespace heel
