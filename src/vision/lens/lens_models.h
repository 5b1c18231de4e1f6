// The lens models beside plumb_bob: the radial factor of the rational model, and the fisheye model.
#pragma once

#include <Eigen/Core>

#include "heel/camera_model.h"

namespace heel {

/// The radial factor at r², and twice its derivative by r².
struct RadialFactor {
  double value = 1.0;
  double slope = 0.0;
};

template <bool kRational>
RadialFactor radial_factor(const CameraModel& camera, double r2) {
  const double value = 1.0 + r2 * (camera.k1 + r2 * (camera.k2 + r2 * camera.k3));
  const double slope = 2.0 * (camera.k1 + r2 * (2.0 * camera.k2 + r2 * 3.0 * camera.k3));
  if constexpr (!kRational) return {value, slope};
  const double below = 1.0 + r2 * (camera.k4 + r2 * (camera.k5 + r2 * camera.k6));
  const double below_slope = 2.0 * (camera.k4 + r2 * (2.0 * camera.k5 + r2 * 3.0 * camera.k6));
  return {value / below, (slope * below - value * below_slope) / (below * below)};
}

/// Angle to the optical axis → distance from the principal point, over the focal length; and its derivative.
double fisheye_distance(const CameraModel& camera, double theta_rad);
double fisheye_slope(const CameraModel& camera, double theta_rad);

/// In normalised coordinates. Directions of more than 89° from the optical axis are taken for 89°, because no
/// point of a plane is seen beyond 90°.
Eigen::Vector2d distort_fisheye(const CameraModel& camera, const Eigen::Vector2d& undistorted);
Eigen::Vector2d undistort_fisheye(const CameraModel& camera, const Eigen::Vector2d& distorted);

}  // namespace heel
