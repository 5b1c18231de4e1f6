/// \file
/// The pinhole camera with plumb-bob distortion.
///
/// - Convention: camera frame x right, y down, z forward; pixel (0,0) is the centre of the top-left pixel.
///   With (x, y) = (X/Z, Y/Z) and r² = x² + y², a point is seen at x_px = fx x' + cx, y_px = fy y' + cy,
///   where
///   \verbatim
///   x' = x (1 + k1 r² + k2 r⁴ + k3 r⁶) + 2 p1 x y + p2 (r² + 2 x²)
///   y' = y (1 + k1 r² + k2 r⁴ + k3 r⁶) + p1 (r² + 2 y²) + 2 p2 x y
///   \endverbatim
/// - Units: pixels for points, focal lengths and centre; the distortion coefficients have none.
/// - Errors: none; every function gives a result for every input.
/// - Source: D. C. Brown, "Decentering Distortion of Lenses", Photogrammetric Engineering 32(3), 1966; names
///   and order of the coefficients are those of OpenCV and of ROS ("plumb_bob").
#pragma once

#include <Eigen/Core>

namespace heel {

/// Intrinsics: focal lengths and centre, radial distortion k1, k2, k3, tangential distortion p1, p2.
struct CameraModel {
  int width_px = 0;
  int height_px = 0;
  double fx = 0.0, fy = 0.0, cx = 0.0, cy = 0.0;
  double k1 = 0.0, k2 = 0.0, p1 = 0.0, p2 = 0.0, k3 = 0.0;

  /// The camera matrix: x_px ~ K (x, y, 1).
  Eigen::Matrix3d K() const;
  /// Whether any distortion coefficient differs from 0.
  bool distorted() const { return k1 != 0 || k2 != 0 || p1 != 0 || p2 != 0 || k3 != 0; }

  /// Distorted pixel → undistorted pixel of the same K, to 1e-9 px. For a pixel that no direction maps to
  /// (beyond the fold of a strong barrel distortion) the nearest point that the iteration reaches.
  Eigen::Vector2d undistort_px(const Eigen::Vector2d& distorted_px) const;
  /// Undistorted pixel → distorted pixel.
  Eigen::Vector2d distort_px(const Eigen::Vector2d& undistorted_px) const;
};

}  // namespace heel
