#include "config/config_reader.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <optional>
#include <utility>

#include "config/config_table.h"
#include "config/config_value.h"
#include "toml/toml_file.h"

namespace heel {
namespace {

bool is_choice(std::string_view text, std::string_view choices) {
  const std::vector<std::string_view> known = split_choices(choices);
  return std::find(known.begin(), known.end(), text) != known.end();
}

/// 127.0.0.1:8080 or [::1]:8080; empty: none.
bool is_listen_address(std::string_view text) {
  if (text.empty()) return true;
  const std::size_t colon = text.rfind(':');
  if (colon == std::string_view::npos) return false;
  const std::string_view port_text = text.substr(colon + 1);
  std::uint16_t port = 0;
  const auto [end, error] = std::from_chars(port_text.data(), port_text.data() + port_text.size(), port);
  if (error != std::errc() || end != port_text.data() + port_text.size()) return false;
  std::string host(text.substr(0, colon));
  in6_addr address{};
  if (!host.starts_with('[')) return inet_pton(AF_INET, host.c_str(), &address) == 1;
  return host.ends_with(']') && inet_pton(AF_INET6, host.substr(1, host.size() - 2).c_str(), &address) == 1;
}

/// Of a host: letters, digits, hyphens and dots.
bool is_host_name(std::string_view text) {
  const auto fits = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '.';
  };
  return !text.empty() && text.size() <= 253 && std::all_of(text.begin(), text.end(), fits);
}

/// tcp://broker:1883 or ssl://[::1]:8883; empty: none.
bool is_broker(std::string_view text) {
  if (text.empty()) return true;
  if (!text.starts_with("tcp://") && !text.starts_with("ssl://")) return false;
  text.remove_prefix(6);
  const std::size_t colon = text.rfind(':');
  if (colon == std::string_view::npos) return false;
  const std::string_view port_text = text.substr(colon + 1);
  std::uint16_t port = 0;
  const auto [end, error] = std::from_chars(port_text.data(), port_text.data() + port_text.size(), port);
  if (error != std::errc() || end != port_text.data() + port_text.size() || port == 0) return false;
  return is_host_name(text.substr(0, colon)) || (text.starts_with('[') && is_listen_address(text));
}

/// One line of text.
bool is_line(std::string_view text) {
  const auto fits = [](char c) { return static_cast<unsigned char>(c) >= ' ' && c != 0x7f; };
  return text.size() <= 128 && std::all_of(text.begin(), text.end(), fits);
}

/// No wildcard, no level without a name, and none of the broker's own topics.
bool is_topic(std::string_view text) {
  return !text.empty() && is_line(text) && text.find_first_of("+#") == std::string_view::npos &&
         text.front() != '$' && text.front() != '/' && text.back() != '/' &&
         text.find("//") == std::string_view::npos;
}

bool text_is_valid(const ConfigKey& key, std::string_view text) {
  switch (key.text) {
    case ConfigText::Choice:
      return is_choice(text, key.choices);
    case ConfigText::Path:
      return true;
    case ConfigText::Listen:
      return is_listen_address(text);
    case ConfigText::Name:
      return is_host_name(text);
    case ConfigText::Broker:
      return is_broker(text);
    case ConfigText::Topic:
      return is_topic(text);
    case ConfigText::Text:
      return is_line(text);
    case ConfigText::Address: {
      const auto colon = text.find(':');
      return colon != std::string_view::npos && colon + 1 < text.size() &&
             is_choice(text.substr(0, colon), key.choices);
    }
  }
  return false;
}

/// The only values that the key has in its range; empty: all of them.
std::string requirement_of(std::string_view key) {
  for (const auto& relation : config_relations())
    if (relation.key == key && relation.lists_values) return fmt::format("; it {}", relation.requirement);
  return "";
}

/// Stores a TOML value in its member of Config; false when it has the wrong type or is out of range.
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
    const double value = *value_.value<double>() + 0.0;  // -0.0 becomes 0.0
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
  bool operator()(std::vector<std::string>* (*field)(Config&)) const {
    const auto* values = value_.as_array();
    if (!values || !in_range(static_cast<double>(values->size()))) return false;
    std::vector<std::string> texts;
    for (const toml::node& value : *values) {
      const auto* text = value.as_string();
      if (!text || text->get().empty() || !text_is_valid(key_, text->get())) return false;
      texts.push_back(text->get());
    }
    *field(config_) = std::move(texts);
    return true;
  }

 private:
  bool in_range(double value) const { return value >= key_.min && value <= key_.max; }  // false for NaN

  const ConfigKey& key_;
  const toml::node& value_;
  Config& config_;
};

std::vector<std::string> key_names() {
  std::vector<std::string> names;
  for (const auto& key : config_keys()) names.push_back(key.full_name());
  return names;
}

std::string why_unknown(std::string_view full_name) {
  for (const auto& removed : removed_config_keys()) {
    if (removed.full_name == full_name) return fmt::format("removed: {}; delete this line", removed.reason);
  }
  return "no such key" + nearest_name_question(std::string(full_name), key_names());
}

std::vector<std::string> section_names() {
  std::vector<std::string> names;
  for (const auto& section : config_sections()) names.emplace_back(section.name);
  return names;
}

}  // namespace

ConfigReader::ConfigReader(LoadedConfig& out) : out_(out) {
  out_.line_of.assign(config_keys().size(), 0);
}

void ConfigReader::read(const toml::table& root) {
  const std::vector<std::string> sections = section_names();
  for (const auto& [name, node] : root) {
    const std::string key(name.str());
    const auto* section = node.as_table();
    if (std::find(sections.begin(), sections.end(), key) == sections.end()) {
      // A key outside its section is a likely mistake: full key names are candidates as well.
      std::vector<std::string> candidates = sections;
      for (std::string& full_name : key_names()) candidates.push_back(std::move(full_name));
      add_error(name.source().begin, key,
                (section ? "no such section" : "no such key") + nearest_name_question(key, candidates));
    } else if (!section) {
      add_error(name.source().begin, key, fmt::format("is a section (expected [{}])", key));
    } else {
      read_section(key, *section);
    }
  }
  // With a value missing, a relation may fail for that reason alone.
  if (errors_.empty()) check_relations();
  if (!errors_.empty()) throw_errors();
}

void ConfigReader::read_section(std::string_view section, const toml::table& table) {
  for (const auto& [name, node] : table) {
    const std::string full_name = fmt::format("{}.{}", section, name.str());
    const auto index = index_of_key(full_name);
    if (!index) {
      add_error(name.source().begin, full_name, why_unknown(full_name));
      continue;
    }
    const ConfigKey& key = config_keys()[*index];
    out_.line_of[*index] = static_cast<int>(node.source().begin.line);
    if (!std::visit(ValueSetter(key, node, out_.config), key.field)) {
      add_error(node.source().begin, full_name,
                fmt::format("{} (expected {}{})", toml_value_text(node), expected_value(key),
                            requirement_of(full_name)));
    }
  }
}

void ConfigReader::check_relations() {
  for (const auto& relation : config_relations()) {
    if (relation.holds(out_.config)) continue;
    const auto index = *index_of_key(relation.key);
    const std::string value = toml_value(config_keys()[index], out_.config);
    // A key at its default value has no line: the error then names the file only.
    const auto line = static_cast<toml::source_index>(out_.line_of[index]);
    add_error({line, line ? 1u : 0u}, std::string(relation.key),
              fmt::format("{} ({})", value, relation.requirement));
  }
}

void ConfigReader::add_error(toml::source_position at, const std::string& key, const std::string& what) {
  errors_.push_back({at, toml_message(out_.file, at, key, what)});
}

void ConfigReader::throw_errors() {
  // A TOML table is ordered by name; people read a file from the top.
  std::stable_sort(errors_.begin(), errors_.end(), [](const PlacedError& a, const PlacedError& b) {
    return std::pair(a.at.line, a.at.column) < std::pair(b.at.line, b.at.column);
  });
  std::vector<std::string> lines;
  for (PlacedError& error : errors_) lines.push_back(std::move(error.line));
  throw ConfigError(std::move(lines));
}

}  // namespace heel
