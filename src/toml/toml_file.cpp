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

namespace {

/// The line of `text` that has this number, from 1.
std::string_view line_of(std::string_view text, std::size_t number) {
  for (; number > 1 && text.find('\n') != std::string_view::npos; --number)
    text.remove_prefix(text.find('\n') + 1);
  return text.substr(0, text.find('\n'));
}

/// A number with a comma in it, outside of lists: "= 0,5".
bool has_decimal_comma(std::string_view line) {
  const std::size_t comma = line.find(',');
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  return comma != std::string_view::npos && comma > 0 && comma + 1 < line.size() &&
         is_digit(line[comma - 1]) && is_digit(line[comma + 1]) && line.find('[') == std::string_view::npos;
}

/// What was expected where `line` cannot be read, by what programs for text make of a file.
std::string_view expected_text(std::string_view text, std::string_view line, std::string_view description) {
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff"))
    return "UTF-8; this is UTF-16: save it as UTF-8";
  if (description.find("utf-8") != std::string_view::npos) return "UTF-8: save it as that";
  for (const std::string_view quote : {"\u201c", "\u201d", "\u201e", "\u2018", "\u2019"})
    if (line.find(quote) != std::string_view::npos) return "straight quotes: \"…\"";
  if (has_decimal_comma(line)) return "a point in a number, as 0.5";
  return "TOML";
}

}  // namespace

toml::table parse_toml(std::string_view text, const std::string& file) {
  try {
    return toml::parse(text, file);
  } catch (const toml::parse_error& error) {
    const toml::source_position at = error.source().begin;
    throw Error(fmt::format("{}:{}:{}: {} (expected {})", file, at.line, at.column, error.description(),
                            expected_text(text, line_of(text, at.line), error.description())));
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
