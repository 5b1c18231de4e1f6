// Whether a homography can be a view of the shirt. Wrong homographies (with four or five inliers by chance)
// fold, mirror or collapse the outline of the template; a right one maps it to a convex quadrilateral of
// plausible size.
//
// Convention: x_cur ~ H_cur_from_ref x_ref. Units: undistorted pixels.
#pragma once

#include <Eigen/Core>
#include <array>

namespace heel {

using Outline = std::array<Eigen::Vector2d, 4>;  ///< px, in order round the region

struct ShapeLimits {
  double scale_min = 0.1;  ///< square root of the area ratio, current to reference
  double scale_max = 10.0;
  double squeeze_min = 0.2;  ///< shorter to longer axis of the image of a small circle: cosine of the tilt
  double depth_ratio_max = 4.0;  ///< farthest to nearest corner of the outline
};

/// True if the outline's image lies in front of the camera, is convex and not mirrored, and is within the
/// limits.
bool plausible_shape(const Eigen::Matrix3d& H_cur_from_ref, const Outline& outline_ref_px,
                     const ShapeLimits& limits);

/// The magnification of H near a point: the square root of |det (d cur / d ref)|.
double local_scale(const Eigen::Matrix3d& H_cur_from_ref, const Eigen::Vector2d& ref_px);

}  // namespace heel
