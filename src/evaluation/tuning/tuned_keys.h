// The keys of the configuration that `heel tune` may change, and between which values.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "core/config.h"

namespace heel::evaluation {

/// A number of [control] that a running heeld can take over.
struct TunedKey {
  std::size_t index;  ///< in config_keys()
  double low, high;   ///< heel tune stays within, and within the key's own range

  std::string name() const;
};

/// The keys called `names`, or those that shape the motion under the law of `config` when there are none.
/// Each may become `factor` times smaller or larger than in `config`. Throws heel::Error with one line:
/// unknown, no such number, given twice, or 0 in `config` (which has no multiples).
std::vector<TunedKey> tuned_keys(const Config& config, const std::vector<std::string>& names, double factor);

double value_of(const TunedKey& key, const Config& config);

/// `config` with these values, in the order of `keys`.
Config with_values(Config config, std::span<const TunedKey> keys, std::span<const double> values);

/// Whether every condition on the values of two keys holds.
bool relations_hold(const Config& config);

}  // namespace heel::evaluation
