// How the page's JSON is written: numbers rounded, text made valid.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "operator/json_number.h"

namespace heel {

using ViewJson = nlohmann::ordered_json;

/// Names of files and texts of robots may hold bytes that are no UTF-8: those are replaced.
inline std::string text_of(const ViewJson& json) {
  return json.dump(-1, ' ', false, ViewJson::error_handler_t::replace);
}

}  // namespace heel
