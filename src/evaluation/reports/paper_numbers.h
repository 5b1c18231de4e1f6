// The numbers of the paper's Figures 7 and 8 on our runs (M. Burke and W. Brink, PRASA 2010).
#pragma once

#include <string>

#include "evaluation/metrics/metrics.h"

namespace heel::evaluation {

/// Figure 7, DIR/fig7_response.csv: the robot set down beside a person's straight line at another heading;
/// both places, distance from the line and heading against it over the distance driven.
void write_response(const std::string& directory, const MetricsCollector& run);

/// Figure 8, DIR/fig8_walk.csv and fig8_walk.json: a long walk, and, where there is such a run, the path of a
/// robot that follows the position only.
void write_walk(const std::string& directory, const MetricsCollector& run,
                const MetricsCollector* position_only);

}  // namespace heel::evaluation
