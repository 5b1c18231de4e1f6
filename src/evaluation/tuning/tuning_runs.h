// The runs by which values are judged: every scenario with every seed, in lock step with sampled poses.
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "evaluation/metrics/metrics.h"
#include "evaluation/tuning/tuned_keys.h"
#include "sim/lockstep/lockstep.h"

namespace heel::evaluation {

/// The same runs for all values that are compared.
struct TuningRuns {
  std::vector<sim::LockstepSettings> scenarios;
  std::uint64_t first_seed = 1;
  int seeds = 1;
};

struct Judgement {
  std::vector<FollowMetrics> runs;  ///< scenario by scenario, each with its seeds in order
  double cost = 0.0;                ///< mean of cost_of over the runs
};

/// The runs with these values, on all processors. The same values give the same judgement to the bit.
Judgement judge(const TuningRuns& runs, std::span<const TunedKey> keys, std::span<const double> values);

}  // namespace heel::evaluation
