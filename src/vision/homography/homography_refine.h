// Refinement of a homography, and its precision from the residuals.
//
// Convention: x_cur ~ H_cur_from_ref x_ref; covariances of the entries are row-major. Units: pixels.
// Source: R. Hartley and A. Zisserman, "Multiple View Geometry", 2nd ed., 4.5, 5.2, A6.2.
#pragma once

#include <Eigen/Core>
#include <span>

#include "heel/homography.h"

namespace heel {

using Matrix9d = Eigen::Matrix<double, 9, 9>;

/// Levenberg–Marquardt on Σ ρ(e) over `pairs`, where e is the squared symmetric transfer error and ρ Tukey's
/// biweight loss. Pairs with e ≥ limit_px2 have no weight; below the limit the weight decreases continuously
/// to zero, so that no pair changes the result abruptly by crossing a threshold. An infinite limit is plain
/// least squares. H(2,2) must not be near zero: shift the coordinates to the points' centroid first. Returns
/// the final sum, px²; H is replaced only by one of a smaller sum.
double refine_homography(std::span<const PointPair> pairs, double limit_px2, Eigen::Matrix3d& H_cur_from_ref);

struct HomographyPrecision {
  double noise_px = 0.0;                   ///< one standard deviation of a coordinate, in either image
  double rms_px = 0.0;                     ///< one-way error in the current image, root mean square
  Matrix9d covariance = Matrix9d::Zero();  ///< of H's entries, row-major, H(2,2) fixed
};

/// First-order covariance of a homography that minimises the symmetric transfer error, for independent noise
/// of equal size in both images. The size is estimated from the residuals. Both directions of a pair share
/// the same noise (5.2), so the inverse of the normal matrix alone would be too small.
HomographyPrecision homography_precision(std::span<const PointPair> pairs,
                                         const Eigen::Matrix3d& H_cur_from_ref);

}  // namespace heel
