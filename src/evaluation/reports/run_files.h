// A run's folder (truth.csv and the recording) as samples for metrics and figures.
#pragma once

#include <string>

#include "evaluation/metrics/metrics.h"

namespace heel::evaluation {

/// Real-time runs carry the daemon's and the simulator's clock in truth.csv (t_monotonic_s); lock-step runs
/// have one clock. Times in the result are those of the recording. Throws heel::Error.
MetricsCollector read_run(const std::string& directory);

}  // namespace heel::evaluation
