/// \file
/// The camera's motion from a homography of a plane: all solutions, and the choice of one.
///
/// - Convention: camera frames x right, y down, z forward; the plane is nᵀ X_ref = d, its unit normal n
///   points away from the reference camera; X_cur = R_cur_from_ref X_ref + t, and A = K_cur⁻¹ H_cur_from_ref
///   K_ref = R + (t/d) nᵀ up to scale.
/// - Units: radians; translations in units of the plane's distance d.
/// - Errors: a matrix that is singular or not finite gives PlaneMotionCase::Degenerate and no solution.
/// - Source: O. Faugeras, F. Lustman, "Motion and structure from motion in a piecewise planar environment",
///   IJPRAI 2(3), 1988, equations (12) to (16).
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>

namespace heel {

/// Which case of the paper the singular values d1 ≥ d2 ≥ d3 fall into (relative tolerance, never ==).
enum class PlaneMotionCase : std::uint8_t {
  Distinct,      ///< d1 > d2 > d3: the general case, eight solutions
  TwoEqual,      ///< d1 = d2 or d2 = d3: translation along the plane's normal
  PureRotation,  ///< d1 = d2 = d3: t = 0, the normal is undetermined
  Degenerate,    ///< singular or not finite: no homography of a plane
};

/// One solution.
struct PlaneMotion {
  Eigen::Matrix3d R_cur_from_ref = Eigen::Matrix3d::Identity();
  Eigen::Vector3d t_over_d = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal_ref = Eigen::Vector3d::UnitZ();  ///< unit; away from the reference camera
  bool same_side = true;  ///< d' > 0: both cameras on the same side of the plane
};

/// All solutions of one matrix.
struct PlaneMotions {
  PlaneMotionCase kind = PlaneMotionCase::Degenerate;
  int count = 0;  ///< up to eight
  std::array<PlaneMotion, 8> motions;
};

/// All solutions of A = R + (t/d) nᵀ, A known up to scale and sign. The tolerance is relative to d2 for
/// PureRotation and Degenerate, and the angle (rad) of the normal to a singular vector for TwoEqual.
PlaneMotions decompose_plane_motion(const Eigen::Matrix3d& A, double relative_tolerance = 1e-6);

/// Indices into PlaneMotions::motions; −1: none.
struct MotionChoice {
  int best = -1;
  int second = -1;  ///< passes the same tests; its normal is the second nearest
};
/// The paper's choice: both cameras on the same side of the plane; most of the reference points (normalised,
/// undistorted) in front of both cameras; then the normal nearest to the known one.
MotionChoice choose_motion(const PlaneMotions& motions, std::span<const Eigen::Vector2d> ref_normalised,
                           const Eigen::Vector3d& known_normal_ref = Eigen::Vector3d::UnitZ());

/// Rotation of R about the camera's y axis: the direction R (0,0,1) projected on the x–z plane;
/// positive turns it to the image's right.
double yaw_of_rotation(const Eigen::Matrix3d& R_cur_from_ref);

}  // namespace heel
