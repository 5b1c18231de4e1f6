#include "config/config_edit.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <string_view>

#include "config/config_table.h"
#include "config/config_value.h"
#include "heel/error.h"
#include "toml/toml_file.h"

namespace heel {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// The byte at a place of toml++, which counts lines and code points from 1.
std::size_t offset_of(std::string_view text, toml::source_position at) {
  std::size_t offset = text.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0;
  for (toml::source_index line = 1; line < at.line; ++line) offset = text.find('\n', offset) + 1;
  for (toml::source_index column = 1; column < at.column; ++column) {
    do ++offset;
    while (offset < text.size() && (static_cast<unsigned char>(text[offset]) & 0xC0u) == 0x80u);
  }
  return offset;
}

/// Where the line after the one of `offset` begins; the end of the text when there is none.
std::size_t next_line(std::string_view text, std::size_t offset) {
  const std::size_t newline = text.find('\n', offset);
  return newline == std::string_view::npos ? text.size() : newline + 1;
}

/// How the line before `offset`, or the whole text, ends its lines.
std::string_view line_end_before(std::string_view text, std::size_t offset) {
  std::string_view before = text.substr(0, offset);
  const std::size_t newline = before.rfind('\n');
  if (newline == std::string_view::npos) return text.find("\r\n") == std::string_view::npos ? "\n" : "\r\n";
  return newline > 0 && before[newline - 1] == '\r' ? "\r\n" : "\n";
}

/// Puts lines in at `offset`, the start of a line or the end of the text.
void insert_lines(std::string& text, std::size_t offset, const std::vector<std::string>& lines) {
  const std::string end(line_end_before(text, offset));
  std::string inserted;
  if (offset > 0 && text[offset - 1] != '\n' && text != kByteOrderMark) inserted = end;
  for (const std::string& line : lines) inserted += line + end;
  text.insert(offset, inserted);
}

class TextEdit {
 public:
  TextEdit(std::string& text, const std::string& file) : text_(text), file_(file) {}

  void apply(const ConfigChange& change) {
    const auto dot = change.key.find('.');
    const std::string section = change.key.substr(0, dot), name = change.key.substr(dot + 1);
    // Read again for each change: the one before has moved what comes after it.
    const toml::table root = parse_toml(text_, file_);
    const toml::table* table = root[section].as_table();
    if (table == nullptr) {
      add_section(section, name, change.after);
    } else if (const toml::node* value = table->get(name)) {
      replace(*value, change.after);
    } else {
      add_key(*table, change.key, name, change.after);
    }
  }

 private:
  void replace(const toml::node& value, const std::string& by) {
    const std::size_t begin = offset_of(text_, value.source().begin);
    text_.replace(begin, offset_of(text_, value.source().end) - begin, by);
  }

  void add_key(const toml::table& table, const std::string& full_name, const std::string& name,
               const std::string& value) {
    const toml::source_region& place = table.source();
    if (text_[offset_of(text_, place.begin)] != '[') {
      throw Error(fmt::format(
          "{}:{}:{}: {}: cannot be added to a section that is written as an inline table or as dotted keys "
          "(expected [{}] on a line of its own)",
          file_, place.begin.line, place.begin.column, full_name, full_name.substr(0, full_name.find('.'))));
    }
    std::size_t last = offset_of(text_, place.end);
    for (const auto& [key, node] : table) last = std::max(last, offset_of(text_, node.source().end));
    insert_lines(text_, next_line(text_, last), {name + " = " + value});
  }

  void add_section(const std::string& section, const std::string& name, const std::string& value) {
    std::vector<std::string> lines = {"[" + section + "]", name + " = " + value};
    if (!text_.empty()) lines.insert(lines.begin(), "");
    insert_lines(text_, text_.size(), lines);
  }

  std::string& text_;
  const std::string& file_;
};

/// What will be written is read again first: it must hold these values, and every other as before.
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

}  // namespace

std::string edited_config_text(const std::string& text, const std::string& file,
                               std::span<const ConfigChange> changes) {
  std::string edited = text;
  TextEdit edit(edited, file);
  for (const ConfigChange& change : changes) edit.apply(change);

  check_edit(text, edited, file, changes);
  return edited;
}

}  // namespace heel
