// Uneven ground under the wheels: a height for every place, and how the robot stands on it.
#pragma once

#include <array>
#include <cstdint>

namespace heel::sim {

/// How a robot on uneven ground stands, from level.
struct Stand {
  double lift_m = 0.0;
  double pitch_rad = 0.0;  ///< + nose up
  double roll_rad = 0.0;   ///< + left side up
};

class Ground {
 public:
  /// `bump_m`: one standard deviation of the height; 0 is a level floor.
  Ground(double bump_m, std::uint64_t seed);

  double height_m(double x_m, double y_m) const;
  /// A robot on four wheels with its middle at (x, y).
  Stand stand(double x_m, double y_m, double heading_rad) const;

 private:
  struct Wave {
    double kx = 0.0, ky = 0.0, phase_rad = 0.0, height_m = 0.0;
  };
  bool level_;
  std::array<Wave, 10> waves_;
};

}  // namespace heel::sim
