// Checks of option values that CLI11 does not have.
#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include "commands.h"

namespace heel::cli {

namespace {

/// NaN when `text` is no number and nothing else.
double number_in(const std::string& text) {
  double value = 0.0;
  const char* end = text.data() + text.size();
  const auto [used, error] = std::from_chars(text.data(), end, value);
  return error == std::errc{} && used == end ? value : std::numeric_limits<double>::quiet_NaN();
}

std::string range_text(double least, double most) {
  return fmt::format("{:g}…{:g}", least, most);
}

}  // namespace

CLI::Validator number_from(double least, double most) {
  const std::string range = range_text(least, most);
  const auto check = [least, most, range](const std::string& text) -> std::string {
    const double value = number_in(text);
    if (value >= least && value <= most) return {};
    return fmt::format("'{}' (expected a number, {})", text, range);
  };
  return {check, range};
}

CLI::Validator metres_from(double least, double most) {
  const std::string range = range_text(least, most);
  const auto check = [least, most, range](const std::string& text) -> std::string {
    const double value = number_in(text);
    if (value >= least && value <= most) return {};
    const double from_mm = value / 1e3;
    const bool may_be_mm = from_mm >= least && from_mm <= most;
    return fmt::format("'{}' (expected metres, {}{})", text, range,
                       may_be_mm ? fmt::format("; {:g} mm are {:g}", value, from_mm) : "");
  };
  return {check, range};
}

CLI::Validator whole_number(const std::string& kind) {
  const auto check = [kind](const std::string& text) -> std::string {
    std::uint64_t value = 0;
    const char* end = text.data() + text.size();
    const auto [used, error] = std::from_chars(text.data(), end, value);
    if (error == std::errc{} && used == end) return {};
    if (error == std::errc::result_out_of_range)
      return fmt::format("'{}' (expected {}, 0…{})", text, kind, std::numeric_limits<std::uint64_t>::max());
    return fmt::format("'{}' (expected {}, 0 or more)", text, kind);
  };
  return {check, {}};
}

CLI::Validator duration_s() {
  const auto check = [](const std::string& text) -> std::string {
    double value_s = 0.0;
    const char* end = text.data() + text.size();
    const auto [used, error] = std::from_chars(text.data(), end, value_s);
    if (error == std::errc{} && used == end && std::isfinite(value_s) && value_s > 0.0) return {};
    return fmt::format("'{}' (expected seconds, more than 0)", text);
  };
  return {check, {}};
}

}  // namespace heel::cli
