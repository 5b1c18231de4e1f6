// What `heel watch` shows on a terminal.
#pragma once

#include <string>
#include <vector>

#include "operator_client.h"

namespace heel::cli {

struct WatchLook {
  int columns = 80;
  bool colour = true;
  double news_age_s = 0.0;  ///< since the status came
  std::string note;         ///< what became of the last key
};

/// State and sentence, then a line each about speed, person, shirt, way, robot, camera and what was set, and
/// the keys.
std::vector<std::string> watch_screen(const Json& status, const WatchLook& look);

}  // namespace heel::cli
