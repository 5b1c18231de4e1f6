// Angles in radians.
#pragma once

#include <cmath>
#include <numbers>

namespace heel {

inline constexpr double kDegPerRad = 180.0 / std::numbers::pi;
inline constexpr double kRadPerDeg = std::numbers::pi / 180.0;

/// The same direction in [−π, π].
inline double wrap_angle_rad(double angle_rad) {
  return std::remainder(angle_rad, 2.0 * std::numbers::pi);
}

}  // namespace heel
