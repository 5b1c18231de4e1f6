// Text for man(7): what its macros and escapes would take for their own is escaped.
#pragma once

#include <string>
#include <string_view>

namespace heel::commandline {

/// One line without macros; `…` in back-quotes is bold.
std::string roff_text(std::string_view text);
/// Lines are joined, except that those which begin with spaces stay lines.
std::string roff_paragraph(std::string_view text);
/// .TH of a page.
std::string roff_title(std::string_view name, int section, std::string_view version);

}  // namespace heel::commandline
