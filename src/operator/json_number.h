// Numbers in the JSON that people and plots read.
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>

namespace heel {

/// Rounded to whole steps; what is not finite is null.
inline nlohmann::ordered_json json_number(double value, double steps_per_unit = 1e4) {
  if (!std::isfinite(value)) return nullptr;
  return std::round(value * steps_per_unit) / steps_per_unit;
}

}  // namespace heel
