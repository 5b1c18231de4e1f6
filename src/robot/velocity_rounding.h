// Whole wire units whose mean is what was asked: the rounding error of each command is carried into the next.
// RVEL counts in whole degrees a second: without this, a robot asked for 0.6 deg/s would turn with 1 or 0.
#pragma once

#include <cstdint>

namespace heel {

class VelocityRounding {
 public:
  /// Wire units; commands are clamped to ±limit.
  explicit VelocityRounding(int limit) : limit_(limit) {}

  /// The next whole command for `wanted` (wire units, a fraction). Zero is zero at once, with nothing
  /// carried: a robot told to rest must not be sent a last leftover unit. Not a number counts as zero.
  std::int16_t next(double wanted);

  void reset() { carry_ = 0.0; }

 private:
  int limit_;
  double carry_ = 0.0;  ///< what the commands so far fell short of the sum asked; −0.5…0.5
};

}  // namespace heel
