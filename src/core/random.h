// Random numbers that repeat: the same seed gives the same numbers on every machine and with every library.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

namespace heel {

/// SplitMix64 (G. Steele, D. Lea, C. Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014).
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t next() {
    state_ += 0x9e3779b97f4a7c15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
  }

  /// Uniform integer in [0, bound), bound > 0; the bias of the multiply-shift is below 2⁻³² · bound.
  std::uint32_t below(std::uint32_t bound) {
    return static_cast<std::uint32_t>(((next() >> 32) * bound) >> 32);
  }
  /// Uniform integer in [0, count), from the generator's upper 53 bits.
  int index(int count) { return static_cast<int>(uniform() * count); }
  /// Uniform in [0, 1).
  double uniform() { return static_cast<double>(next() >> 11) * 0x1.0p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Standard normal (Box–Muller).
  double normal() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return radius * std::cos(2.0 * std::numbers::pi * uniform());
  }

 private:
  std::uint64_t state_;
};

/// A seed of its own for one part of a simulated world, so that a change of one part leaves the others as
/// they are.
inline std::uint64_t derived_seed(std::uint64_t seed, std::uint64_t part) {
  return Random(seed ^ (part * 0xd1342543de82ef95ULL)).next();
}

}  // namespace heel
