// Uneven ground: its height at every place, and the pose of the robot on it.
#pragma once

#include <array>
#include <cstdint>

namespace heel::sim {

/// The robot's deviation from a level floor.
struct GroundPose {
  double lift_m = 0.0;
  double pitch_rad = 0.0;  ///< + nose up
  double roll_rad = 0.0;   ///< + left side up
};

class Ground {
 public:
  /// `bump_m`: standard deviation of the height; 0: a level floor.
  Ground(double bump_m, std::uint64_t seed);

  double height_m(double x_m, double y_m) const;
  /// Of a robot on four wheels with its centre at (x, y).
  GroundPose pose_at(double x_m, double y_m, double heading_rad) const;

 private:
  struct Wave {
    double kx = 0.0, ky = 0.0, phase_rad = 0.0, height_m = 0.0;
  };
  bool level_;
  std::array<Wave, 10> waves_;
};

}  // namespace heel::sim
