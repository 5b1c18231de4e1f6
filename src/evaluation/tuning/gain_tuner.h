// Values of keys that make the cost of runs small: a bounded search without derivatives (NLopt's Sbplx,
// T. Rowan's subspace-searching simplex), on a logarithmic scale.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "evaluation/tuning/tuned_keys.h"

namespace heel::evaluation {

/// The cost of values, in the order of the keys.
using Cost = std::function<double(std::span<const double> values)>;

struct SearchStep {
  std::vector<double> values;
  double cost = 0.0;
  double least_cost = 0.0;  ///< of the steps so far
};

/// Called after each step; false ends the search.
using GoOn = std::function<bool(const SearchStep& step)>;

/// All steps of the search, `start` first, `most_steps` at most. Every value is within the bounds of its
/// key. Throws what `cost` throws.
std::vector<SearchStep> search(std::span<const TunedKey> keys, const std::vector<double>& start,
                               const Cost& cost, int most_steps, const GoOn& go_on);

/// The first step of least cost.
const SearchStep& best_step(const std::vector<SearchStep>& steps);

}  // namespace heel::evaluation
