// Rounds velocities to whole wire units and adds the rounding error of each command to the next one, so that
// the mean is the velocity wanted. RVEL has whole degrees per second: without this, 0.6 deg/s would become 1
// or 0.
#pragma once

#include <cstdint>

namespace heel {

class VelocityRounding {
 public:
  /// Wire units; commands are clamped to ±limit.
  explicit VelocityRounding(int limit) : limit_(limit) {}

  /// The next whole command for `wanted` (wire units). Zero gives zero and discards the carried error, so
  /// that a robot at rest gets no last unit. NaN and infinity count as zero.
  std::int16_t next(double wanted);

 private:
  int limit_;
  double carry_ = 0.0;  ///< wanted minus sent, summed over the commands so far; −0.5…0.5
};

}  // namespace heel
