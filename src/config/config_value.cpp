#include "config/config_value.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <type_traits>

namespace heel {
namespace {

std::string toml_string(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + '"';
}

/// Each choice with `suffix`, separated by ", " and, before the last one, `before_last`.
std::string listed(const ConfigKey& key, std::string_view suffix, std::string_view before_last) {
  const std::vector<std::string_view> choices = split_choices(key.choices);
  std::string result;
  for (std::size_t i = 0; i < choices.size(); ++i) {
    if (i > 0) result += i + 1 == choices.size() ? before_last : ", ";
    result.append(choices[i]).append(suffix);
  }
  return result;
}

struct TomlWriter {
  Config& config;
  std::string operator()(bool* (*field)(Config&)) const { return *field(config) ? "true" : "false"; }
  std::string operator()(int* (*field)(Config&)) const { return fmt::to_string(*field(config)); }
  std::string operator()(double* (*field)(Config&)) const {
    const std::string text = fmt::to_string(*field(config));
    return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
  }
  std::string operator()(std::string* (*field)(Config&)) const { return toml_string(*field(config)); }
  std::string operator()(std::vector<std::string>* (*field)(Config&)) const {
    std::vector<std::string> values;
    for (const std::string& value : *field(config)) values.push_back(toml_string(value));
    return fmt::format("[{}]", fmt::join(values, ", "));
  }
};

}  // namespace

std::string toml_value(const ConfigKey& key, const Config& config) {
  // The accessors are shared with the parser and take a Config that can be written; this only reads.
  return std::visit(TomlWriter{const_cast<Config&>(config)}, key.field);
}

double number_value(const ConfigKey& key, const Config& config) {
  const auto number = [&](auto field) -> double {
    const auto& value = *field(const_cast<Config&>(config));
    if constexpr (std::is_arithmetic_v<std::remove_cvref_t<decltype(value)>>)
      return static_cast<double>(value);
    return 0.0;
  };
  return std::visit(number, key.field);
}

std::string expected_value(const ConfigKey& key) {
  const std::string_view type = type_name(key);
  if (type == "bool") return "true or false";
  if (type == "path") return "a path in quotes";
  if (type == "paths") return fmt::format("at most {} paths in quotes, as [\"a\", \"b\"]", key.max);
  if (type == "names") return fmt::format("at most {} names of hosts in quotes, as [\"a\", \"b\"]", key.max);
  if (type == "listen") return "IP:PORT in quotes, as \"127.0.0.1:8080\", or \"\"";
  if (type == "broker")
    return "tcp://HOST:PORT or ssl://HOST:PORT in quotes, as \"tcp://broker.example:1883\", or \"\"";
  if (type == "topic") return "names between slashes in quotes, without + and #, as \"heel/robot-1\"";
  if (type == "text") return "one line of text in quotes, at most 128 bytes";
  if (type == "address") return listed(key, ":…", " or ") + ", in quotes";
  if (type == "choice") return listed(key, "", " or ");
  return fmt::format("a {}number {}…{}{}{}", type == "int" ? "whole " : "", key.min, key.max,
                     key.unit.empty() ? "" : " ", key.unit);
}

std::string value_range(const ConfigKey& key) {
  const std::string_view type = type_name(key);
  if (type == "bool") return "true, false";
  if (type == "path") return "path";
  if (type == "paths") return fmt::format("{}…{} paths", key.min, key.max);
  if (type == "names") return fmt::format("{}…{} names", key.min, key.max);
  if (type == "listen") return "IP:PORT";
  if (type == "broker") return "tcp://HOST:PORT, ssl://HOST:PORT";
  if (type == "topic" || type == "text") return std::string(type);
  if (type == "address") return listed(key, ":…", ", ");
  if (type == "choice") return listed(key, "", ", ");
  return fmt::format("{}…{}{}", key.min, key.max, type == "int" ? ", whole" : "");
}

std::string_view type_name(const ConfigKey& key) {
  switch (key.field.index()) {
    case 0:
      return "bool";
    case 1:
      return "int";
    case 2:
      return "real";
    case 4:
      return key.text == ConfigText::Name ? "names" : "paths";
    default:
      break;
  }
  switch (key.text) {
    case ConfigText::Choice:
      return "choice";
    case ConfigText::Path:
      return "path";
    case ConfigText::Address:
      return "address";
    case ConfigText::Listen:
      return "listen";
    case ConfigText::Name:
      return "name";
    case ConfigText::Broker:
      return "broker";
    case ConfigText::Topic:
      return "topic";
    case ConfigText::Text:
      return "text";
  }
  return "?";
}

std::vector<std::string_view> split_choices(std::string_view choices) {
  std::vector<std::string_view> parts;
  while (!choices.empty()) {
    const auto bar = choices.find('|');
    parts.push_back(choices.substr(0, bar));
    choices = bar == std::string_view::npos ? std::string_view{} : choices.substr(bar + 1);
  }
  return parts;
}

std::string_view settable_values(const ConfigKey& key) {
  if (!key.can_be_set()) return "no";
  switch (key.tighter) {
    case Tighter::Smaller:
      return "smaller";
    case Tighter::Larger:
      return "larger";
    default:
      return "yes";
  }
}

}  // namespace heel
