// A name that a robot gives itself, as a message shows it.
#pragma once

#include <algorithm>
#include <string_view>

namespace heel {

/// Whether the name needs no quotation marks to be told from the words around it: letters, digits and - _ .
constexpr bool is_plain_name(std::string_view name) {
  return !name.empty() && std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
           c == '_' || c == '.';
  });
}

}  // namespace heel
