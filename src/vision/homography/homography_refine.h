// Local refinement of a homography, and what its residuals say about its precision.
// Convention: x_cur ~ H_cur_from_ref x_ref.
#pragma once

#include <Eigen/Core>
#include <span>

#include "heel/homography.h"

namespace heel {

using Matrix9d = Eigen::Matrix<double, 9, 9>;

/// Levenberg–Marquardt on Σ ρ(e) over `pairs`, e the squared symmetric transfer error (Hartley & Zisserman,
/// 2nd ed., 4.5 and A6.2) and ρ Tukey's biweight loss: pairs with e ≥ limit_px2 have no say, those below it
/// have less the nearer they come, so that none of them tips the result by crossing a threshold. An infinite
/// limit is plain least squares. H(2,2) must not be near zero in the coordinates used: shift them to the
/// points' centroid. Returns the final sum, px²; H is only ever replaced by a better one.
double refine_homography(std::span<const PointPair> pairs, double limit_px2, Eigen::Matrix3d& H_cur_from_ref);

struct HomographyPrecision {
  double noise_px = 0.0;                   ///< one standard deviation of a coordinate, in either image
  double rms_px = 0.0;                     ///< one-way error in the current image, root mean square
  Matrix9d covariance = Matrix9d::Zero();  ///< of H's entries, row-major, H(2,2) fixed
};

/// First-order covariance of a homography that minimises the symmetric transfer error, for independent noise
/// of equal size in both images, whose size is taken from the residuals (H&Z 5.2: the two directions share
/// the same noise, so the inverse of the normal matrix alone would be too small).
HomographyPrecision homography_precision(std::span<const PointPair> pairs,
                                         const Eigen::Matrix3d& H_cur_from_ref);

}  // namespace heel
