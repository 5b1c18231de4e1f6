// A small seeded random source, so that the same seed gives the same world on every machine.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "heel/split_mix_64.h"

namespace heel::sim {

class Random {
 public:
  explicit Random(std::uint64_t seed) : bits_(seed) {}

  std::uint64_t next() { return bits_.next(); }
  /// Uniform in [0, 1).
  double uniform() { return static_cast<double>(next() >> 11) * 0x1.0p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Uniform integer in [0, count).
  int index(int count) { return static_cast<int>(uniform() * count); }
  /// Standard normal (Box–Muller).
  double normal() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return radius * std::cos(2.0 * std::numbers::pi * uniform());
  }

 private:
  SplitMix64 bits_;
};

/// An independent stream for a part of the world: adding a box must not change the shirt.
inline std::uint64_t derived_seed(std::uint64_t seed, std::uint64_t part) {
  return Random(seed ^ (part * 0xd1342543de82ef95ULL)).next();
}

}  // namespace heel::sim
