#include "commandline/roff.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace heel::commandline {

std::string roff_text(std::string_view text) {
  std::string roff;
  bool bold = false;
  for (const char c : text) {
    if (c == '`')
      roff += (bold = !bold) ? "\\fB" : "\\fR";
    else if (c == '\\')
      roff += "\\e";
    else if (c == '-')
      roff += "\\-";
    else if (c == '\'')
      roff += "\\(aq";
    else if (c == '\n')
      roff += ' ';
    else
      roff += c;
  }
  return roff.starts_with('.') ? "\\&" + roff : roff;
}

std::string roff_paragraph(std::string_view text) {
  std::string roff;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    const bool item = line.starts_with(' ');
    line.remove_prefix(std::min(line.find_first_not_of(' '), line.size()));
    if (line.empty()) continue;
    roff += (item ? ".br\n" : "") + roff_text(line) + "\n";
  }
  return roff;
}

std::string roff_title(std::string_view name, int section, std::string_view version) {
  std::string upper(name);
  std::transform(upper.begin(), upper.end(), upper.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return fmt::format(".TH {} {} \"\" \"{}\"\n", roff_text(upper), section, version);
}

}  // namespace heel::commandline
