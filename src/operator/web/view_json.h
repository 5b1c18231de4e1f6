// How the page's JSON is written: numbers rounded, what is not finite as null, text made valid.
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

namespace heel {

using ViewJson = nlohmann::ordered_json;

inline ViewJson json_number(double value, double steps_per_unit = 1e4) {
  if (!std::isfinite(value)) return nullptr;
  return std::round(value * steps_per_unit) / steps_per_unit;
}

/// Names of files and texts of robots may hold bytes that are no UTF-8: those are replaced.
inline std::string text_of(const ViewJson& json) {
  return json.dump(-1, ' ', false, ViewJson::error_handler_t::replace);
}

}  // namespace heel
