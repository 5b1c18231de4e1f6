#include "shell_word.h"

#include <algorithm>
#include <cctype>
#include <string_view>

namespace heel::cli {
namespace {

constexpr std::string_view kPlainMarks = "_./:@%+=,-";

bool is_plain(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return byte >= 0x80 || std::isalnum(byte) != 0 || kPlainMarks.find(c) != std::string_view::npos;
}

}  // namespace

std::string shell_word(const std::string& text) {
  if (!text.empty() && std::all_of(text.begin(), text.end(), is_plain)) return text;
  std::string word = "'";
  for (const char c : text) {
    if (c == '\'')
      word += "'\\''";  // no character is special between single quotes, so that one stands outside of them
    else
      word += c;
  }
  return word + "'";
}

}  // namespace heel::cli
