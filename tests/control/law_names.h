// The control laws that a configuration may name, for tests of every law.
#pragma once

#include <string>
#include <vector>

#include "config/config_table.h"

namespace heel::test {

inline std::vector<std::string> law_names() {
  std::vector<std::string> names;
  for (const ConfigKey& key : config_keys()) {
    if (key.full_name() != "control.law") continue;
    for (std::string_view rest = key.choices; !rest.empty();) {
      const std::size_t bar = rest.find('|');
      names.emplace_back(rest.substr(0, bar));
      rest = bar == std::string_view::npos ? std::string_view{} : rest.substr(bar + 1);
    }
  }
  return names;
}

}  // namespace heel::test
