#include "config/config_places.h"

#include <fmt/format.h>

#include <algorithm>

#include "config/config_table.h"
#include "config/config_value.h"
#include "heel/error.h"

namespace heel {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// How the line before `offset`, or the whole text, ends its lines.
std::string_view line_end_before(std::string_view text, std::size_t offset) {
  std::string_view before = text.substr(0, offset);
  const std::size_t newline = before.rfind('\n');
  if (newline == std::string_view::npos) return text.find("\r\n") == std::string_view::npos ? "\n" : "\r\n";
  return newline > 0 && before[newline - 1] == '\r' ? "\r\n" : "\n";
}

}  // namespace

std::size_t offset_of(std::string_view text, toml::source_position at) {
  std::size_t offset = text.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0;
  for (toml::source_index line = 1; line < at.line; ++line) offset = text.find('\n', offset) + 1;
  for (toml::source_index column = 1; column < at.column; ++column) {
    do ++offset;
    while (offset < text.size() && (static_cast<unsigned char>(text[offset]) & 0xC0u) == 0x80u);
  }
  return offset;
}

std::size_t line_begin(std::string_view text, std::size_t offset) {
  if (offset == 0) return 0;
  const std::size_t newline = text.rfind('\n', offset - 1);
  return newline == std::string_view::npos ? 0 : newline + 1;
}

std::size_t next_line(std::string_view text, std::size_t offset) {
  const std::size_t newline = text.find('\n', offset);
  return newline == std::string_view::npos ? text.size() : newline + 1;
}

void insert_lines(std::string& text, std::size_t offset, const std::vector<std::string>& lines) {
  const std::string end(line_end_before(text, offset));
  std::string inserted;
  if (offset > 0 && text[offset - 1] != '\n' && text != kByteOrderMark) inserted = end;
  for (const std::string& line : lines) inserted += line + end;
  text.insert(offset, inserted);
}

std::size_t place_of_new_key(std::string_view text, const std::string& file, const toml::table& section,
                             const std::string& key) {
  const toml::source_region& header = section.source();
  if (text[offset_of(text, header.begin)] != '[') {
    throw Error(fmt::format(
        "{}:{}:{}: {}: cannot be added to a section that is written as an inline table or as dotted keys "
        "(expected [{}] on a line of its own)",
        file, header.begin.line, header.begin.column, key, key.substr(0, key.find('.'))));
  }
  std::size_t last = offset_of(text, header.end);
  for (const auto& [name, node] : section) last = std::max(last, offset_of(text, node.source().end));
  const std::size_t place = next_line(text, last);
  const bool in_block = text.substr(place).starts_with(kBlockEnd);
  return in_block ? next_line(text, place) : place;
}

void append_section(std::string& text, const std::string& section, std::vector<std::string> lines) {
  lines.insert(lines.begin(), "[" + section + "]");
  if (!text.empty()) lines.insert(lines.begin(), "");
  insert_lines(text, text.size(), lines);
}

void check_edit(const std::string& text, const std::string& edited, const std::string& file,
                std::span<const ConfigChange> changes) {
  Config expected = parse_config(text, file).config;
  Config found = parse_config(edited, file).config;
  bool right = true;
  for (const ConfigChange& change : changes) {
    const ConfigKey& key = config_keys()[*index_of_key(change.key)];
    right = right && toml_value(key, found) == change.after;
    std::visit([&](auto field) { *field(expected) = *field(found); }, key.field);
  }
  if (!right || !changes_between(expected, found).empty())
    throw Error(file + ": cannot be edited (expected each value where its key is; edit it by hand)");
}

}  // namespace heel
