// Over whole runs: how often the target is found, how often it is wrong, how long until it is found again.
#pragma once

#include <string>
#include <vector>

#include "evaluation/metrics/metrics.h"

namespace heel::evaluation {

struct RunLine {
  std::string name;
  FollowMetrics metrics;
  std::size_t frames = 0, found = 0;              ///< while the person walked
  std::size_t found_of_visible = 0, visible = 0;  ///< frames in which the middle of the back was in view
  std::size_t wrong = 0;                          ///< is_wrong()
  std::vector<double> gaps_s;  ///< from the last frame with the target to the next one, losses only
};

RunLine run_line(const std::string& name, const MetricsCollector& run);

/// A line a run, as a Markdown table.
std::string run_table(const std::vector<RunLine>& lines);

/// The same scenarios in the pictured world and in the world without pictures, by name: Markdown. Empty where
/// no name is in both.
std::string worlds_table(const std::vector<RunLine>& pictured, const std::vector<RunLine>& without);

}  // namespace heel::evaluation
