// What `heel simulate` prints of its runs: one run in detail, several as a table, all as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "evaluation/metrics/metrics.h"
#include "sim/lockstep/lockstep.h"

namespace heel::cli {

struct SimulatedRun {
  std::string scenario;
  std::string shows;
  std::uint64_t seed = 0;
  std::string refused;  ///< why the run was not started; empty when it was
  sim::LockstepCounts counts;
  evaluation::FollowMetrics metrics;
  std::vector<std::string> failed;  ///< one line for each criterion that is not met
  double speed = 0.0;               ///< simulated seconds per second
};

/// Without any figure of wall-clock time: the same run gives the same text.
nlohmann::ordered_json to_json(const SimulatedRun& run);
/// One run as text.
std::string detailed_text(const SimulatedRun& run);
/// Several runs as a table, a line for each, and what each scenario shows.
std::string table_text(const std::vector<SimulatedRun>& runs);

}  // namespace heel::cli
