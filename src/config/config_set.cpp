#include "config/config_set.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <utility>

#include "config/config_reader.h"
#include "config/config_table.h"
#include "config/config_value.h"

namespace heel {
namespace {

/// Why the key cannot be set at all; empty: it can, or it is not known and the reader says so.
std::string why_not_settable(const std::string& name) {
  const auto index = index_of_key(name);
  if (!index) return "";
  const ConfigKey& key = config_keys()[*index];
  if (key.reload == Reload::No)
    return fmt::format("{}: cannot change while running (edit the file, then restart heeld)", name);
  if (!key.can_be_set())
    return fmt::format("{}: a limit that only the file sets (edit the file, then reload heeld)", name);
  return "";
}

/// Why the new value of the key is less safe than the file's; empty: it is not.
std::string why_looser(const ConfigKey& key, const Config& wanted, const Config& file) {
  if (key.tighter == Tighter::None) return "";
  const double value = number_value(key, wanted), limit = number_value(key, file);
  const bool smaller_is_tighter = key.tighter == Tighter::Smaller;
  if (smaller_is_tighter ? value <= limit : value >= limit) return "";
  const std::string expected =
      key.min == key.max
          ? toml_value(key, file)
          : fmt::format("at {} {}", smaller_is_tighter ? "most" : "least", toml_value(key, file));
  return fmt::format("{}: {} (expected {}, the file's value: a limit is only made tighter while heeld runs)",
                     key.full_name(), toml_value(key, wanted), expected);
}

/// The assignments as the tables of a file.
toml::table as_tables(std::span<const ConfigAssignment> assignments) {
  toml::table root;
  for (const ConfigAssignment& assignment : assignments) {
    const auto dot = assignment.key.find('.');
    toml::table* table = &root;
    std::string name = assignment.key;
    if (dot != std::string::npos) {
      const std::string section = name.substr(0, dot);
      name = name.substr(dot + 1);
      // A key and a section of one name: the key, which cannot be right, is reported.
      table = root.insert(section, toml::table{}).first->second.as_table();
      if (table == nullptr) continue;
    }
    std::visit([&](const auto& value) { table->insert_or_assign(name, value); }, assignment.value);
  }
  return root;
}

}  // namespace

Config with_assignments(const Config& current, const Config& file,
                        std::span<const ConfigAssignment> assignments) {
  std::vector<std::string> reasons;
  for (const ConfigAssignment& assignment : assignments) {
    std::string reason = why_not_settable(assignment.key);
    if (!reason.empty()) reasons.push_back(std::move(reason));
  }
  if (!reasons.empty()) throw ConfigError(std::move(reasons));

  LoadedConfig wanted;
  wanted.config = current;
  ConfigReader(wanted).read(as_tables(assignments));
  for (const ConfigAssignment& assignment : assignments) {
    std::string reason = why_looser(config_keys()[*index_of_key(assignment.key)], wanted.config, file);
    if (!reason.empty()) reasons.push_back(std::move(reason));
  }
  if (!reasons.empty()) throw ConfigError(std::move(reasons));
  return wanted.config;
}

std::vector<ConfigChange> changes_between(const Config& before, const Config& after) {
  std::vector<ConfigChange> changes;
  for (const auto& key : config_keys()) {
    ConfigChange change{key.full_name(), toml_value(key, before), toml_value(key, after)};
    if (change.before != change.after) changes.push_back(std::move(change));
  }
  return changes;
}

}  // namespace heel
