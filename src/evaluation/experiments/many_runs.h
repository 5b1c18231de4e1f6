// The same scenario with many seeds: how following varies.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "evaluation/metrics/metrics.h"

namespace heel::evaluation {

/// Over runs, one value a run.
struct ManyRuns {
  std::vector<FollowMetrics> runs;
  double simulated_s = 0.0;
};

/// Quantiles of path RMS, separation, nearest separation, found share, longest time out of view, stops.
nlohmann::ordered_json to_json(const ManyRuns& many);
std::string many_runs_table(const ManyRuns& many);

}  // namespace heel::evaluation
