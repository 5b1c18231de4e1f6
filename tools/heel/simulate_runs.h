// The three kinds of work of `heel simulate`. Each prints its results; all throw heel::Error, and
// CLI::RuntimeError when a criterion is not met.
#pragma once

#include <vector>

#include "simulate_options.h"

namespace heel::cli {

/// One run, in detail.
void simulate_one(const SimulateOptions& options, const sim::Scenario& scenario);

/// A run of each scenario, with a folder for each in the output folder, a table and figures. A shirt that
/// cannot be followed is a result, not an error.
void simulate_several(const SimulateOptions& options, const std::vector<sim::Scenario>& scenarios);

/// `options.runs` runs of one scenario with consecutive seeds, and statistics over them. With an error model
/// the runs are shared among the processor's cores; without, drawing one run already uses them all.
void simulate_many(const SimulateOptions& options, const sim::Scenario& scenario);

}  // namespace heel::cli
