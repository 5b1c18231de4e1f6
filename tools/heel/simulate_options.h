// The command line of `heel simulate`, and a run's settings by it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/metrics/metrics.h"
#include "sim/lockstep/lockstep.h"

namespace heel::cli {

/// Where several runs are written when no folder is named.
inline constexpr const char* kSimulateDefaultOut = "out/simulate";

struct SimulateOptions {
  std::vector<std::string> scenarios;  ///< files and folders
  std::string config_file;
  std::string template_file;
  std::string error_model_file;
  std::string out;
  double teach_distance_m = 1.5;
  std::optional<std::uint64_t> seed;
  double duration_s = 0.0;  ///< 0: the scenario's
  int runs = 1;
  bool json = false;
  evaluation::FollowCriteria criteria;
};

/// The scenario files that the arguments name; a folder stands for the *.toml in it, in the order of their
/// names. Throws heel::Error for a folder without any.
std::vector<std::string> scenario_files(const std::vector<std::string>& arguments);

/// The scenario in `file` with the seed and duration of the options. Throws heel::Error.
sim::Scenario scenario_of(const SimulateOptions& options, const std::string& file);

/// Everything a run in lock step needs. Throws heel::Error, also when the scenario's shirt cannot be
/// followed.
sim::LockstepSettings settings_of(const SimulateOptions& options, const sim::Scenario& scenario);

}  // namespace heel::cli
