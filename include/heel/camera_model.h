/// \file
/// The camera: a pinhole with plumb-bob or rational distortion, or a fisheye lens.
///
/// - Convention: camera frame x right, y down, z forward; pixel (0,0) is the centre of the top-left pixel.
///   With (x, y) = (X/Z, Y/Z) and r² = x² + y², a point is seen at x_px = fx x' + cx, y_px = fy y' + cy,
///   where
///   \verbatim
///   x' = x (1 + k1 r² + k2 r⁴ + k3 r⁶) + 2 p1 x y + p2 (r² + 2 x²)
///   y' = y (1 + k1 r² + k2 r⁴ + k3 r⁶) + p1 (r² + 2 y²) + 2 p2 x y
///   \endverbatim
///   The rational model divides the radial factor (1 + k1 r² + …) by 1 + k4 r² + k5 r⁴ + k6 r⁶. The fisheye
///   model is \verbatim θ = atan r,  θ_d = θ (1 + k1 θ² + k2 θ⁴ + k3 θ⁶ + k4 θ⁸),  (x', y') = (x, y) θ_d / r
///   \endverbatim
/// - Units: pixels for points, focal lengths and centre; the distortion coefficients have none.
/// - Errors: none; every function gives a result for every input.
/// - Source: D. C. Brown, "Decentering Distortion of Lenses", Photogrammetric Engineering 32(3), 1966; names
///   and order of the coefficients are those of OpenCV and of ROS ("plumb_bob", "rational_polynomial",
///   "equidistant"). Fisheye: J. Kannala, S. S. Brandt, "A Generic Camera Model and Calibration Method for
///   Conventional, Wide-Angle, and Fish-Eye Lenses", PAMI 28(8), 2006.
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace heel {

/// How directions become points of the picture.
enum class LensModel : std::uint8_t {
  PlumbBob,  ///< k1, k2, k3, p1, p2
  Rational,  ///< these and k4, k5, k6
  Fisheye,   ///< k1, k2, k3, k4: distorted also when all are 0
};

/// Intrinsics: focal lengths and centre, radial distortion k1 to k6, tangential distortion p1, p2.
struct CameraModel {
  int width_px = 0;
  int height_px = 0;
  double fx = 0.0, fy = 0.0, cx = 0.0, cy = 0.0;
  double k1 = 0.0, k2 = 0.0, p1 = 0.0, p2 = 0.0, k3 = 0.0;
  LensModel lens = LensModel::PlumbBob;
  double k4 = 0.0, k5 = 0.0, k6 = 0.0;

  /// The camera matrix: x_px ~ K (x, y, 1).
  Eigen::Matrix3d K() const;
  /// Whether the lens differs from a pinhole.
  bool distorted() const {
    return k1 != 0 || k2 != 0 || p1 != 0 || p2 != 0 || k3 != 0 || lens != LensModel::PlumbBob;
  }

  /// Distorted pixel → undistorted pixel of the same K, to 1e-9 px. For a pixel that no direction maps to
  /// (beyond the fold of a strong barrel distortion) the nearest point that the iteration reaches. For a
  /// pixel of a fisheye lens that sees more than 89° from the optical axis, the place of 89°.
  Eigen::Vector2d undistort_px(const Eigen::Vector2d& distorted_px) const;
  /// Undistorted pixel → distorted pixel.
  Eigen::Vector2d distort_px(const Eigen::Vector2d& undistorted_px) const;
};

}  // namespace heel
