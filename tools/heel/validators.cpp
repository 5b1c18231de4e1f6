// Checks of option values that CLI11 does not have.
#include <fmt/format.h>

#include <charconv>
#include <string>

#include "commands.h"

namespace heel::cli {

CLI::Validator number_from(double least, double most) {
  const std::string range = fmt::format("{:g}…{:g}", least, most);
  const auto check = [least, most, range](const std::string& text) -> std::string {
    double value = 0.0;
    const char* end = text.data() + text.size();
    const auto [used, error] = std::from_chars(text.data(), end, value);
    if (error == std::errc{} && used == end && value >= least && value <= most) return {};
    return fmt::format("'{}' (expected a number, {})", text, range);
  };
  return {check, range};
}

}  // namespace heel::cli
