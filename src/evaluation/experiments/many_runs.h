// Statistics over many runs of one scenario with different seeds.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "evaluation/metrics/metrics.h"

namespace heel::evaluation {

struct ManyRuns {
  std::vector<FollowMetrics> runs;
  double simulated_s = 0.0;
};

/// Mean, deviation and quantiles over the runs of path RMS, the figures of FollowingFigures, separation,
/// smallest separation, share of frames in which the shirt was found, longest time out of view, robot path
/// and stops.
nlohmann::ordered_json to_json(const ManyRuns& many);
std::string many_runs_table(const ManyRuns& many);

}  // namespace heel::evaluation
