#include "operator/settings.h"

#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "config/config_edit.h"
#include "config/config_table.h"
#include "config/config_value.h"
#include "files/atomic_file.h"
#include "heel/error.h"

namespace heel {
namespace {

constexpr std::size_t kMaxFileBytes = 1 << 20;

/// The file itself where the path is a symbolic link: that is what a save replaces.
std::string real_file(const std::string& path) {
  std::error_code error;
  const std::filesystem::path real = std::filesystem::canonical(path, error);
  return error ? path : real.string();
}

}  // namespace

Settings::Settings(LoadedConfig loaded, SettingsHooks hooks)
    : file_(loaded.file), loaded_(std::move(loaded)), in_use_(loaded_.config), hooks_(std::move(hooks)) {
  publish();
}

std::vector<ConfigChange> Settings::set(std::span<const ConfigAssignment> assignments) {
  const Config wanted = with_assignments(in_use_, loaded_.config, assignments);
  hooks_.check(wanted);
  std::vector<ConfigChange> changes = changes_between(in_use_, wanted);
  if (changes.empty()) return changes;
  hooks_.apply(wanted);
  in_use_ = wanted;
  publish();
  return changes;
}

std::vector<ConfigChange> Settings::save() {
  std::vector<ConfigChange> changes = changes_between(loaded_.config, in_use_);
  if (changes.empty()) return changes;
  const std::string text = read_whole_file(file_, kMaxFileBytes);
  const std::vector<ConfigChange> edited_by_others =
      changes_between(loaded_.config, parse_config(text, file_).config);
  if (!edited_by_others.empty()) {
    throw Error(
        fmt::format("{}: {} has changed since heeld read it (expected the file as it was; reload heeld, "
                    "which drops the values "
                    "that were set, then set and save again)",
                    file_, edited_by_others.front().key));
  }
  const std::string edited = edited_config_text(text, file_, changes);
  write_file_atomically(real_file(file_), edited);
  loaded_ = parse_config(edited, file_);
  publish();
  return changes;
}

std::vector<ConfigChange> Settings::reload() {
  LoadedConfig changed = load_config(file_);
  hooks_.check(changed.config);
  std::vector<std::string> fixed;
  for (const std::string& key : keys_needing_restart(loaded_.config, changed.config)) {
    fixed.push_back(
        fmt::format("{}: {} cannot change while running; restart heeld to change it", file_, key));
  }
  if (!fixed.empty()) throw ConfigError(std::move(fixed));
  hooks_.apply(changed.config);
  std::vector<ConfigChange> dropped;
  for (ConfigChange& change : changes_between(in_use_, changed.config)) {
    const ConfigKey& key = config_keys()[*index_of_key(change.key)];
    if (toml_value(key, loaded_.config) != change.before) dropped.push_back(std::move(change));
  }
  loaded_ = std::move(changed);
  in_use_ = loaded_.config;
  publish();
  return dropped;
}

void Settings::publish() {
  const std::lock_guard lock(mutex_);
  view_ = {loaded_.config, in_use_};
}

SettingsView Settings::view() const {
  const std::lock_guard lock(mutex_);
  return view_;
}

}  // namespace heel
