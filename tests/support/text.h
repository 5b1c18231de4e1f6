// Counting in text.
#pragma once

#include <string>
#include <string_view>

namespace heel::test {

/// How often `what` occurs in `text`.
inline int occurrences(std::string_view text, std::string_view what) {
  int n = 0;
  for (std::size_t at = text.find(what); at != std::string_view::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

}  // namespace heel::test
