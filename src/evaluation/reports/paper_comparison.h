// What the paper says and what ours shows, side by side; and the goals of the design beside the measured.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "evaluation/reports/run_table.h"
#include "evaluation/reports/still_samples.h"

namespace heel::evaluation {

/// What there is to compare; parts that were not run are empty.
struct ExperimentData {
  std::vector<StillSample> lateral, distance, yaw, errors;
  std::optional<RunLine> walk, walk_position_only;

  std::vector<StillSample> all_stills() const;
};

/// Coefficient of determination of the straight line through (x, y); 0 for fewer than three points.
double r_squared(const std::vector<double>& x, const std::vector<double>& y);

/// The commanded values at which the mean does not grow, in words; empty: monotone. Steps in which fewer than
/// half of the pictures showed the target are left out and said so.
std::string breaks_of_monotony(const std::vector<Step>& steps, const std::string& unit);

std::string paper_table(const ExperimentData& data);  ///< Markdown
std::string goals_table(const ExperimentData& data);  ///< Markdown

}  // namespace heel::evaluation
