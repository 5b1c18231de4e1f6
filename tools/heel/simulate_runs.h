// The runs of `heel simulate` and what is said of them: one in detail, several as a table.
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
  std::string refused;  ///< why the run was never begun; empty: it was
  sim::LockstepCounts counts;
  evaluation::FollowMetrics metrics;
  std::vector<std::string> failed;
  double times_real = 0.0;  ///< simulated seconds a second
};

/// The scenario files that arguments name: a folder stands for its *.toml, by name. Throws heel::Error on a
/// name that is neither, and on a folder without any.
std::vector<std::string> scenario_files(const std::vector<std::string>& arguments);

/// No wall-clock figure: the same run prints the same bytes.
nlohmann::ordered_json to_json(const SimulatedRun& run);
/// For people, about one run.
std::string detailed_text(const SimulatedRun& run);
/// For people, a line a run and what its scenario is hard by.
std::string table_text(const std::vector<SimulatedRun>& runs);

}  // namespace heel::cli
