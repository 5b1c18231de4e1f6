#include "config/config_block.h"

#include <fmt/format.h>

#include <algorithm>

#include "config/config_places.h"
#include "config/config_table.h"
#include "config/config_value.h"
#include "heel/error.h"
#include "toml/toml_file.h"

namespace heel {
namespace {

constexpr std::string_view kReplaced = "# (before heel tune) ";

std::size_t line_number(std::string_view text, std::size_t offset) {
  return 1 + static_cast<std::size_t>(std::ranges::count(text.substr(0, offset), '\n'));
}

/// Where the first line that begins with `mark` begins; npos without one.
std::size_t find_line(std::string_view text, std::string_view mark, std::size_t from = 0) {
  for (std::size_t at = from; at < text.size(); at = next_line(text, at))
    if (text.substr(at).starts_with(mark)) return at;
  return std::string_view::npos;
}

/// Takes an earlier block out of `text`: the values that the file has by it.
std::vector<ConfigChange> take_block(std::string& text, const std::string& file) {
  const std::size_t begin = find_line(text, kBlockBegin);
  if (begin == std::string::npos) return {};
  const std::size_t last = find_line(text, kBlockEnd, begin);
  if (last == std::string::npos)
    throw Error(fmt::format("{}:{}: '{}' without an end (expected '{}' on a line below)", file,
                            line_number(text, begin), kBlockBegin, kBlockEnd));
  std::string without = text;
  without.erase(begin, next_line(text, last) - begin);
  std::vector<ConfigChange> values =
      changes_between(parse_config(without, file).config, parse_config(text, file).config);
  text = without;
  return values;
}

/// The line that sets `name`, if there is one, becomes a comment.
void comment_out(std::string& text, const std::string& file, const ConfigChange& change,
                 const std::string& section, const std::string& name) {
  const toml::table root = parse_toml(text, file);
  const toml::node* value = root[section][name].node();
  if (value == nullptr) return;
  const std::size_t begin = line_begin(text, offset_of(text, value->source().begin));
  const std::string_view line = std::string_view(text).substr(begin, next_line(text, begin) - begin);
  const std::size_t first = line.find_first_not_of(" \t");
  if (!line.substr(first).starts_with(name))
    throw Error(
        fmt::format("{}:{}: {}: is set in an inline table or by a dotted key (expected '{} = …' on a "
                    "line of its own, below [{}])",
                    file, line_number(text, begin), change.key, name, section));
  text.insert(begin, kReplaced);
}

}  // namespace

std::string config_text_with_block(const std::string& text, const std::string& file,
                                   std::span<const ConfigChange> changes,
                                   const std::vector<std::string>& about) {
  std::string edited = text;
  std::vector<ConfigChange> all = take_block(edited, file);
  for (const ConfigChange& change : changes) {
    const auto same = std::ranges::find(all, change.key, &ConfigChange::key);
    if (same == all.end()) {
      all.push_back(change);
    } else {
      same->after = change.after;
    }
  }

  std::vector<std::string> lines{std::string(kBlockBegin)};
  for (const std::string& line : about) lines.push_back("# " + line);
  std::string section;
  for (const ConfigChange& change : all) {
    const std::size_t dot = change.key.find('.');
    section = change.key.substr(0, dot);
    const std::string name = change.key.substr(dot + 1);
    comment_out(edited, file, change, section, name);
    lines.push_back(name + " = " + change.after);
  }
  lines.emplace_back(kBlockEnd);

  const toml::table root = parse_toml(edited, file);
  if (const toml::table* table = root[section].as_table()) {
    std::size_t place = place_of_new_key(edited, file, *table, all.front().key);
    while (std::string_view(edited).substr(place).starts_with(kReplaced)) place = next_line(edited, place);
    insert_lines(edited, place, lines);
  } else {
    append_section(edited, section, lines);
  }
  check_edit(text, edited, file, all);
  return edited;
}

}  // namespace heel
