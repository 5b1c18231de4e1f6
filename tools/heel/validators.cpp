// Checks of option values that CLI11 has not.
#include <charconv>
#include <cstdio>
#include <string>

#include "commands.h"

namespace heel::cli {

CLI::Validator number_from(double least, double most) {
  char range[64];
  std::snprintf(range, sizeof range, "%g…%g", least, most);
  const auto check = [least, most, expected = std::string(range)](const std::string& text) -> std::string {
    double value = 0.0;
    const char* end = text.data() + text.size();
    const auto [used, error] = std::from_chars(text.data(), end, value);
    if (error == std::errc{} && used == end && value >= least && value <= most) return {};
    return "'" + text + "' (expected a number, " + expected + ")";
  };
  return {check, range};
}

}  // namespace heel::cli
