#include "config/config_load.h"

#include <toml++/toml.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <utility>

#include "config/config_nearest.h"
#include "config/config_table.h"

namespace heel {
namespace {

namespace fs = std::filesystem;

std::string joined(const std::vector<std::string>& lines) {
  std::string result;
  for (const auto& line : lines) result += (result.empty() ? "" : "\n") + line;
  return result;
}

std::string resolved_path(const std::string& path, const fs::path& folder) {
  if (path.empty() || fs::path(path).is_absolute()) return path;
  return (folder / path).lexically_normal().string();
}

/// The path part of v4l2:, file:, serial: and pty: addresses is taken relative to the folder.
std::string resolved_address(const std::string& address, const fs::path& folder) {
  const auto colon = address.find(':');
  const std::string scheme = address.substr(0, colon);
  const bool holds_path = scheme == "v4l2" || scheme == "file" || scheme == "serial" || scheme == "pty";
  if (!holds_path) return address;
  return scheme + ":" + resolved_path(address.substr(colon + 1), folder);
}

bool is_choice(std::string_view text, std::string_view choices) {
  while (!choices.empty()) {
    const auto bar = choices.find('|');
    if (choices.substr(0, bar) == text) return true;
    choices = bar == std::string_view::npos ? std::string_view{} : choices.substr(bar + 1);
  }
  return false;
}

bool text_is_valid(const ConfigKey& key, std::string_view text) {
  switch (key.text) {
    case ConfigText::Choice:
      return is_choice(text, key.choices);
    case ConfigText::Path:
      return true;
    case ConfigText::Address: {
      const auto colon = text.find(':');
      return colon != std::string_view::npos && colon + 1 < text.size() &&
             is_choice(text.substr(0, colon), key.choices);
    }
  }
  return false;
}

/// Puts a TOML value into a member; false when it is of the wrong type or out of range.
class ValueSetter {
 public:
  ValueSetter(const ConfigKey& key, const toml::node& value, Config& config)
      : key_(key), value_(value), config_(config) {}

  bool operator()(bool* (*field)(Config&)) const {
    const auto* value = value_.as_boolean();
    if (!value) return false;
    *field(config_) = value->get();
    return true;
  }
  bool operator()(int* (*field)(Config&)) const {
    const auto* value = value_.as_integer();
    if (!value || !in_range(static_cast<double>(value->get()))) return false;
    *field(config_) = static_cast<int>(value->get());
    return true;
  }
  bool operator()(double* (*field)(Config&)) const {
    if (!value_.is_number()) return false;
    const double value = *value_.value<double>();
    if (!in_range(value)) return false;
    *field(config_) = value;
    return true;
  }
  bool operator()(std::string* (*field)(Config&)) const {
    const auto* value = value_.as_string();
    if (!value || !text_is_valid(key_, value->get())) return false;
    *field(config_) = value->get();
    return true;
  }

 private:
  bool in_range(double value) const { return value >= key_.min && value <= key_.max; }  // NaN is not

  const ConfigKey& key_;
  const toml::node& value_;
  Config& config_;
};

/// Walks the parsed file against the table and collects every complaint.
class Reader {
 public:
  explicit Reader(LoadedConfig& out) : out_(out) { out_.line_of.assign(config_keys().size(), 0); }

  void read(const toml::table& root) {
    for (const auto& [name, node] : root) {
      const auto* section = node.as_table();
      if (!is_section(name.str())) {
        complain(name.source().begin, std::string(name.str()),
                 (section ? "no such section" : "no such key") + suggestion(name.str(), root_names()));
      } else if (!section) {
        complain(name.source().begin, std::string(name.str()),
                 "is a section; write [" + std::string(name.str()) + "]");
      } else {
        read_section(name.str(), *section);
      }
    }
    check_relations();
    if (complaints_.empty()) return;
    // TOML tables iterate by name; people read from the top.
    std::stable_sort(complaints_.begin(), complaints_.end(), [](const Complaint& a, const Complaint& b) {
      return std::pair(a.at.line, a.at.column) < std::pair(b.at.line, b.at.column);
    });
    std::vector<std::string> lines;
    for (auto& complaint : complaints_) lines.push_back(std::move(complaint.line));
    throw ConfigError(std::move(lines));
  }

 private:
  void read_section(std::string_view section, const toml::table& table) {
    for (const auto& [name, node] : table) {
      const std::string full_name = std::string(section) + "." + std::string(name.str());
      const auto index = index_of(full_name);
      if (!index) {
        complain(name.source().begin, full_name, "no such key" + suggestion(full_name, key_names()));
        continue;
      }
      const ConfigKey& key = config_keys()[*index];
      out_.line_of[*index] = static_cast<int>(node.source().begin.line);
      if (!std::visit(ValueSetter(key, node, out_.config), key.field)) {
        complain(node.source().begin, full_name, "is " + shown(node) + ", expected " + expected_value(key));
      }
    }
  }

  void check_relations() {
    if (!complaints_.empty()) return;  // values are not all in place: a relation may fail for that alone
    for (const auto& relation : config_relations()) {
      if (relation.holds(out_.config)) continue;
      const auto index = *index_of(relation.key);
      const std::string value = toml_value(config_keys()[index], out_.config);
      // A key left at its default has no line of its own: the file as a whole is at fault.
      const auto line = static_cast<toml::source_index>(out_.line_of[index]);
      complain({line, line ? 1u : 0u}, std::string(relation.key),
               "is " + value + ", " + std::string(relation.requirement));
    }
  }

  void complain(toml::source_position at, const std::string& key, const std::string& what) {
    std::string place = out_.file;
    if (at.line != 0) place += ":" + std::to_string(at.line) + ":" + std::to_string(at.column);
    complaints_.push_back({at, place + ": " + key + ": " + what});
  }

  static std::string shown(const toml::node& node) {
    std::ostringstream text;
    if (node.is_table()) {
      text << "a section";
    } else if (node.is_array()) {
      text << "a list";
    } else {
      node.visit([&text](const auto& value) {
        if constexpr (toml::is_value<decltype(value)>) text << value;
      });
    }
    return text.str();
  }

  static std::string suggestion(std::string_view name, const std::vector<std::string>& candidates) {
    const std::string nearest = nearest_name(name, candidates);
    return nearest.empty() ? "" : "; did you mean " + nearest + "?";
  }

  static bool is_section(std::string_view name) {
    for (const auto& section : config_sections()) {
      if (section.name == name) return true;
    }
    return false;
  }

  static std::optional<std::size_t> index_of(std::string_view full_name) {
    for (std::size_t i = 0; i < config_keys().size(); ++i) {
      if (config_keys()[i].full_name() == full_name) return i;
    }
    return std::nullopt;
  }

  static std::vector<std::string> key_names() {
    std::vector<std::string> names;
    for (const auto& key : config_keys()) names.push_back(key.full_name());
    return names;
  }

  /// What may stand at the top of a file; bare key names are there for the suggestion only.
  static std::vector<std::string> root_names() {
    std::vector<std::string> names;
    for (const auto& section : config_sections()) names.emplace_back(section.name);
    for (const auto& name : key_names()) names.push_back(name);
    return names;
  }

  struct Complaint {
    toml::source_position at;
    std::string line;
  };

  LoadedConfig& out_;
  std::vector<Complaint> complaints_;
};

void resolve_paths(Config& config, const fs::path& folder) {
  for (const auto& key : config_keys()) {
    auto* const* field = std::get_if<std::string* (*)(Config&)>(&key.field);
    if (!field || key.text == ConfigText::Choice) continue;
    std::string& value = *(*field)(config);
    value = key.text == ConfigText::Path ? resolved_path(value, folder) : resolved_address(value, folder);
  }
}

}  // namespace

ConfigError::ConfigError(std::vector<std::string> lines) : Error(joined(lines)), lines_(std::move(lines)) {}

LoadedConfig parse_config(std::string_view text, const std::string& file) {
  LoadedConfig loaded;
  loaded.file = file;
  try {
    Reader(loaded).read(toml::parse(text, file));
  } catch (const toml::parse_error& error) {
    const auto at = error.source().begin;
    throw ConfigError({file + ":" + std::to_string(at.line) + ":" + std::to_string(at.column) + ": " +
                       std::string(error.description())});
  }
  resolve_paths(loaded.config, fs::path(file).parent_path());
  return loaded;
}

LoadedConfig load_config(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  if (!in || fs::is_directory(path) || !(text << in.rdbuf())) {
    throw ConfigError({path + ": cannot be read (expected a configuration file, see heel.toml)"});
  }
  return parse_config(text.str(), path);
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
