// heel experiment family: each robot that heel knows, against the simulated one's truth.
#pragma once

#include "experiment_options.h"

namespace heel::cli {

/// Writes family.csv into the folder of the options.
void measure_family(const ExperimentOptions& options, ExperimentResults& results);

}  // namespace heel::cli
