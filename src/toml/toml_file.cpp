#include "toml/toml_file.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "heel/error.h"
#include "toml/nearest_name.h"

namespace heel {

std::string read_toml_text(const std::string& path, const std::string& expected) {
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  int why_not = file ? 0 : errno;
  std::error_code none;
  if (std::filesystem::is_directory(path, none)) why_not = EISDIR;  // a folder opens, but cannot be read
  if (!file || why_not != 0)
    throw Error(fmt::format("{}: cannot read: {} (expected {})", path, std::strerror(why_not), expected));
  return {std::istreambuf_iterator<char>(file), {}};
}

toml::table parse_toml(std::string_view text, const std::string& file) {
  try {
    return toml::parse(text, file);
  } catch (const toml::parse_error& error) {
    const toml::source_position at = error.source().begin;
    throw Error(fmt::format("{}:{}:{}: {} (expected TOML)", file, at.line, at.column, error.description()));
  }
}

std::string toml_message(const std::string& file, toml::source_position at, const std::string& key,
                         const std::string& found) {
  if (file.empty()) return fmt::format("{}: {}", key, found);
  if (at.line == 0) return fmt::format("{}: {}: {}", file, key, found);
  return fmt::format("{}:{}:{}: {}: {}", file, at.line, at.column, key, found);
}

std::string toml_value_text(const toml::node& node) {
  if (node.is_table()) return "a section";
  if (node.is_array()) return "a list";
  std::ostringstream text;
  node.visit([&text](const auto& value) {
    if constexpr (toml::is_value<decltype(value)>) text << value;
  });
  return text.str();
}

std::string nearest_name_question(std::string_view name, const std::vector<std::string>& candidates) {
  const std::string nearest = nearest_name(name, candidates);
  return nearest.empty() ? "" : fmt::format("; did you mean {}?", nearest);
}

}  // namespace heel
