// The pinhole camera with plumb-bob distortion, and where the camera sits on the robot.
#pragma once

#include <Eigen/Core>

namespace heel {

/// Intrinsics. Pixel (0,0) is the centre of the top-left pixel.
/// x_px = fx x' + cx, y_px = fy y' + cy with (x', y') the distorted normalised coordinates:
/// radial k1, k2, k3 and tangential p1, p2 as in OpenCV and ROS ("plumb_bob").
struct CameraModel {
  int width_px = 0;
  int height_px = 0;
  double fx = 0.0, fy = 0.0, cx = 0.0, cy = 0.0;
  double k1 = 0.0, k2 = 0.0, p1 = 0.0, p2 = 0.0, k3 = 0.0;

  Eigen::Matrix3d K() const;
  bool distorted() const { return k1 != 0 || k2 != 0 || p1 != 0 || p2 != 0 || k3 != 0; }

  /// Distorted pixel → undistorted pixel of the same K. Iterates to 1e-9 px; total.
  Eigen::Vector2d undistort_px(const Eigen::Vector2d& distorted_px) const;
  /// Undistorted pixel → distorted pixel.
  Eigen::Vector2d distort_px(const Eigen::Vector2d& undistorted_px) const;
};

}  // namespace heel
