#include "toml/toml_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "heel/error.h"
#include "toml/nearest_name.h"

namespace heel {
namespace {

constexpr std::size_t kMaxTomlBytes = std::size_t{4} << 20;
constexpr int kMaxKeyParts = 200;  // the parser calls itself for each part of a key a.b.c

}  // namespace

std::string read_toml_text(const std::string& path, const std::string& expected) {
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  int why_not = file ? 0 : errno;
  std::error_code none;
  if (std::filesystem::is_directory(path, none)) why_not = EISDIR;  // a folder opens, but cannot be read
  if (!file || why_not != 0)
    throw Error(fmt::format("{}: cannot read: {} (expected {})", path, std::strerror(why_not), expected));
  std::string text(kMaxTomlBytes + 1, '\0');  // by reading, because devices state no size
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  if (text.size() > kMaxTomlBytes)
    throw Error(fmt::format("{}: more than {} bytes (expected {})", path, kMaxTomlBytes, expected));
  return text;
}

namespace {

/// The line of `text` that has this number, from 1.
std::string_view line_of(std::string_view text, std::size_t number) {
  for (; number > 1 && text.find('\n') != std::string_view::npos; --number)
    text.remove_prefix(text.find('\n') + 1);
  return text.substr(0, text.find('\n'));
}

void require_short_keys(std::string_view text, const std::string& file) {
  std::size_t line = 1;
  int dots = 0;
  bool comment = false;
  for (const char c : text) {
    if (c == '\n') {
      ++line;
      comment = false;
    }
    comment = comment || c == '#';
    if (std::string_view("\n,[]{}=#").find(c) != std::string_view::npos) dots = 0;
    if (c == '.' && !comment && ++dots > kMaxKeyParts)
      throw Error(fmt::format("{}:{}: a name of more than {} parts (expected section.key)", file, line,
                              kMaxKeyParts));
  }
}

/// A number with a comma in it, outside of lists: "= 0,5".
bool has_decimal_comma(std::string_view line) {
  const std::size_t comma = line.find(',');
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  return comma != std::string_view::npos && comma > 0 && comma + 1 < line.size() &&
         is_digit(line[comma - 1]) && is_digit(line[comma + 1]) && line.find('[') == std::string_view::npos;
}

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

/// What is wrong with the value behind "key =", where it is a word without quotes or a number with its unit.
std::string_view expected_value(std::string_view line) {
  const std::size_t equals = line.find('=');
  if (equals == std::string_view::npos || line.find('"') != std::string_view::npos) return "";
  const std::size_t begin = line.find_first_not_of(" \t", equals + 1);
  if (begin == std::string_view::npos) return "";
  const std::string_view value = line.substr(begin);
  if (is_letter(value[0]) || value[0] == '/' || value[0] == '.') return "text in quotes: \"…\"";
  const std::size_t unit = value.find_first_not_of("+-0123456789._ ");
  return unit != 0 && unit != std::string_view::npos && is_letter(value[unit]) ? "a number without its unit"
                                                                               : "";
}

/// What was expected where `line` cannot be read, by what programs for text make of a file.
std::string_view expected_text(std::string_view text, std::string_view line, std::string_view description) {
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff"))
    return "UTF-8; this is UTF-16: save it as UTF-8";
  if (text.find('\0') != std::string_view::npos) return "text; this is another kind of file, e.g. a picture";
  if (description.find("utf-8") != std::string_view::npos) return "UTF-8: save it as that";
  for (const std::string_view quote : {"\u201c", "\u201d", "\u201e", "\u2018", "\u2019"})
    if (line.find(quote) != std::string_view::npos) return "straight quotes: \"…\"";
  if (has_decimal_comma(line)) return "a point in a number, as 0.5";
  if (text.starts_with("{")) return "TOML, key = value; this is JSON";
  if (description.find("saw ':'") != std::string_view::npos) return "TOML, key = value; is this YAML?";
  const std::string_view value = expected_value(line);
  return value.empty() ? "TOML" : value;
}

}  // namespace

toml::table parse_toml(std::string_view text, const std::string& file) {
  require_short_keys(text, file);
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
