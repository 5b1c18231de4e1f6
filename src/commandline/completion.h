// Names that both shells' completions share.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

namespace heel::commandline {

/// "_heel_sim" of "heel-sim"; "_heel_bench_vision" of "heel bench vision".
inline std::string function_name(const std::string& command) {
  std::string name = "_" + command;
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == '-' || c == ' '; }, '_');
  return name;
}

/// With a space between them.
inline std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

}  // namespace heel::commandline
