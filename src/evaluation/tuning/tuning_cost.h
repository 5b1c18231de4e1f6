// What a run costs: one number that `heel tune` makes small. Each figure counts in units of the value that is
// aimed at (docs/control-laws.md), so that a run which just reaches all of them costs 1. What must not happen
// at all costs more than any figure can.
#pragma once

#include <span>
#include <string_view>

#include "evaluation/metrics/metrics.h"

namespace heel::evaluation {

struct CostTerm {
  std::string_view name;
  std::string_view unit;
  double aim;  ///< the value that counts 1
  double (*value)(const FollowMetrics& metrics);
};

/// Figures of which less is better.
std::span<const CostTerm> cost_terms();

/// Mean of value / aim over the terms, and kFailureCost for each bumper that was pressed, each time the
/// robot came nearer than gate.separation_m, and a person who was not followed to the end.
double cost_of(const FollowMetrics& metrics);

inline constexpr double kFailureCost = 20.0;

}  // namespace heel::evaluation
