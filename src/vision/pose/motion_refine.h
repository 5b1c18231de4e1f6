// The camera's motion against a surface whose place in the reference view is known, from pixels: the last
// step after the decomposition. The decomposition explains all eight degrees of freedom of H by a motion and
// *some* normal, and near the frontal view hands the noise of the perspective terms to the normal and with it
// to the yaw. The reference view is frontoparallel by definition, so six degrees of freedom explain the same
// pairs, several times more precisely, and their covariance is the honest one. Convention: X_cur = R X_ref +
// (t/d) d on the plane z = d, n = (0,0,1): with d = 1, X_ref = (x, y, 1), and behind it on a curved back
// (BackSurface).
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

/// Undistorted pixels of both views, and what turns them into directions.
struct FrontalProblem {
  std::span<const PointPair> pairs;
  Eigen::Matrix3d K_ref, K_cur;
  Eigen::Matrix3d H_cur_from_ref;  ///< tells how far the reference pixels' noise is magnified
  Eigen::Vector2d centre_ref_px;   ///< the template's centre: about it the ambiguity turns
  BackSurface surface = {};        ///< what the reference pixels are pictures of; a plane unless told
};

struct FrontalMotion {
  Eigen::Matrix3d R_cur_from_ref = Eigen::Matrix3d::Identity();
  Eigen::Vector3d t_over_d = Eigen::Vector3d::Zero();
  /// Σ rᵀ W r, px²; W whitens the noise of both images, of equal size.
  double cost_px2 = 0.0;
  double noise_px = 0.0;  ///< one standard deviation of a coordinate, either image
};

/// The other minimum a plane seen from afar has: its normal mirrored in the line of sight to its centre
/// (D. Oberkampf, D. DeMenthon, L. Davis, "Iterative pose estimation using coplanar feature points", CVIU
/// 1996). A start for the refinement, which tells which of the two the pixels support.
PlaneMotion mirrored_motion(const FrontalProblem& problem, const FrontalMotion& motion);

/// The better of both minima, with variances that include the chance of having chosen the wrong one.
struct FrontalPose {
  FrontalMotion motion;
  FrontalMotion other;  ///< the minimum not chosen
  /// Of (ω, δt): R = exp(ω) R̂, t = t̂ + δt; from the noise and from the surface's departures. Finite even
  /// where the pairs leave a direction open: nobody turns by more than π or is farther than 10 d.
  Matrix6d covariance = Matrix6d::Zero();
  double yaw_rad = 0.0;
  double yaw_sigma_rad = 0.0;
  Eigen::Vector3d t_over_d_sigma = Eigen::Vector3d::Zero();
  double ambiguity =
      0.0;  ///< probability that another answer is the true one (alternative_hypotheses.h), 0…1
};

class FrontalPoseEstimator {
 public:
  /// Memory is taken once; of more pairs than `max_pairs` the last are left out.
  explicit FrontalPoseEstimator(std::size_t max_pairs);

  /// Levenberg–Marquardt to both minima, from `start` (its normal is replaced by (0,0,1)) and from its mirror
  /// image.
  FrontalPose estimate(const FrontalProblem& problem, const PlaneMotion& start);

  /// Towards the minimum next to `start` alone, by at most `max_steps` steps.
  FrontalMotion refine(const FrontalProblem& problem, const PlaneMotion& start, int max_steps);

  /// What of a pair stays the same in every step.
  struct WhitenedPair {
    Eigen::Vector3d point_ref;  ///< X_ref / d
    Eigen::Vector2d direction;  ///< (x/z, y/z) of the pixel in the current view
    Eigen::Matrix2d whitening;  ///< from directions to pixels whose noise is 1 px in every direction
    Vector5d departures;        ///< BackSurface::departures, along the normal
    double departure_of_bend;   ///< BackSurface's, along the ray
  };

  /// The derivatives of all residuals, two a pair: a column for each of (ω, δt). And the residuals.
  struct Linearised {
    Eigen::Matrix<double, Eigen::Dynamic, 6> J;
    Eigen::VectorXd residuals;
  };

 private:
  void load(const FrontalProblem& problem);
  FrontalMotion descend(const PlaneMotion& start, int max_steps);

  std::size_t capacity_;
  std::vector<WhitenedPair> pairs_;
  Linearised linearised_;
};

}  // namespace heel
