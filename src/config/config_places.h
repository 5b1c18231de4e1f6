// Places in the text of a configuration file, for edits that keep its comments, order and line ends.
#pragma once

#include <toml++/toml.h>

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "config/config_set.h"

namespace heel {

/// First and last line of a block of keys that heel has written (config_block.h) begin so.
inline constexpr std::string_view kBlockBegin = "# >>> heel tune";
inline constexpr std::string_view kBlockEnd = "# <<< heel tune";

/// The byte at a place of toml++, which counts lines and code points from 1.
std::size_t offset_of(std::string_view text, toml::source_position at);

/// Where the line of `offset` begins.
std::size_t line_begin(std::string_view text, std::size_t offset);

/// Where the line after the one of `offset` begins; the end of the text when there is none.
std::size_t next_line(std::string_view text, std::size_t offset);

/// Puts lines in at `offset`, the start of a line or the end of the text. They end as their neighbours do.
void insert_lines(std::string& text, std::size_t offset, const std::vector<std::string>& lines);

/// Where a line with a further key of this section goes: below the last one, not in a block. Throws
/// heel::Error with one line when the section is written as an inline table or as dotted keys; `key` is the
/// one it names.
std::size_t place_of_new_key(std::string_view text, const std::string& file, const toml::table& section,
                             const std::string& key);

/// The lines of a section that is added at the end of the text.
void append_section(std::string& text, const std::string& section, std::vector<std::string> lines);

/// Throws heel::Error unless `edited` holds the values `ConfigChange::after`, and every other as `text` does.
void check_edit(const std::string& text, const std::string& edited, const std::string& file,
                std::span<const ConfigChange> changes);

}  // namespace heel
