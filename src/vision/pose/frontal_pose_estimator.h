// The pose of a surface whose place in the reference view is known, from pixels: the last step after the
// decomposition.
//
// Convention: X_cur / d = R_cur_from_ref X_ref / d + t_over_d. The reference view is fronto-parallel, so
// X_ref / d = (x, y, 1) on the plane z = d with n = (0,0,1), and farther along the ray on a curved back
// (BackSurface).
// Units: undistorted pixels, radians, t/d.
//
// The decomposition explains all eight degrees of freedom of H by a motion and a free normal; near the
// frontal view the noise of the perspective terms goes to that normal and so to the yaw. With the known
// normal six degrees of freedom explain the same pairs. The pose is several times more precise, and its
// covariance is that of the actual errors.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "heel/homography.h"
#include "heel/motion.h"
#include "vision/pose/back_surface.h"

namespace heel {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// Pairs of both views, and what is known of the cameras and the surface.
struct FrontalProblem {
  std::span<const PointPair> pairs;
  Eigen::Matrix3d K_ref, K_cur;
  Eigen::Matrix3d H_cur_from_ref;  ///< by whose derivative the noise of reference pixels is magnified
  Eigen::Vector2d centre_ref_px;   ///< centre of the template, about which mirrored_motion rotates
  BackSurface surface = {};        ///< that the reference view shows; a plane by default
};

/// A minimum of the cost Σ rᵀ W r, where W whitens the noise of both images.
struct FrontalMotion {
  Eigen::Matrix3d R_cur_from_ref = Eigen::Matrix3d::Identity();
  Eigen::Vector3d t_over_d = Eigen::Vector3d::Zero();
  double cost_px2 = 0.0;
  double noise_px = 0.0;  ///< of a coordinate in either image, one standard deviation, from the residuals
};

/// A start near the second minimum that the cost of a distant plane has: the normal mirrored at the line of
/// sight to the centre (D. Oberkampf, D. DeMenthon, L. Davis, "Iterative pose estimation using coplanar
/// feature points", CVIU 1996).
PlaneMotion mirrored_motion(const FrontalProblem& problem, const FrontalMotion& motion);

/// The better of both minima. The sigmas include the chance that the other one is the true pose.
struct FrontalPose {
  FrontalMotion motion;
  FrontalMotion other;  ///< the minimum not chosen
  /// Of (ω, δt) with R = exp(ω) R̂, t = t̂ + δt: from the noise and from the departures of the surface. A
  /// prior of π and 10 d keeps it finite where the pairs do not determine a direction.
  Matrix6d covariance = Matrix6d::Zero();
  double yaw_rad = 0.0;
  double yaw_sigma_rad = 0.0;
  Eigen::Vector3d t_over_d_sigma = Eigen::Vector3d::Zero();
  double ambiguity = 0.0;  ///< probability that an alternative is the true pose, 0…1
};

/// Of the yaw, for the covariance of (ω, δt): FrontalPose::covariance.
double yaw_sigma_rad(const Eigen::Matrix3d& R_cur_from_ref, const Matrix6d& covariance);

class FrontalPoseEstimator {
 public:
  /// Memory is taken once; pairs beyond `max_pairs` are ignored.
  explicit FrontalPoseEstimator(std::size_t max_pairs);

  /// Levenberg–Marquardt to both minima: from `start`, whose normal is not used, and from the mirror image of
  /// the first minimum.
  FrontalPose estimate(const FrontalProblem& problem, const PlaneMotion& start);

  /// At most `max_steps` steps towards the minimum next to `start`.
  FrontalMotion refine(const FrontalProblem& problem, const PlaneMotion& start, int max_steps);

  /// What is constant of a pair in all steps.
  struct WhitenedPair {
    Eigen::Vector3d point_ref;  ///< X_ref / d
    Eigen::Vector2d direction;  ///< (x/z, y/z) of the pixel in the current view
    Eigen::Matrix2d whitening;  ///< from directions to pixels whose noise is 1 px in every direction
    Vector5d departures;        ///< BackSurface::departures, along the normal
    double departure_of_bend;   ///< BackSurface::departure_of_bend, along the ray
  };

  /// The residuals, two for each pair, and their derivatives with respect to (ω, δt).
  struct Linearised {
    Eigen::Matrix<double, Eigen::Dynamic, 6> J;
    Eigen::VectorXd residuals;
  };

 private:
  std::span<const WhitenedPair> whiten(const FrontalProblem& problem);
  FrontalMotion descend(std::span<const WhitenedPair> pairs, const PlaneMotion& start, int max_steps);

  std::size_t capacity_;
  // Work space: written and read within one call.
  std::vector<WhitenedPair> pairs_;
  Linearised linearised_;
};

}  // namespace heel
