// Can this homography be a view of the shirt at all? Garbage fits (four or five inliers by chance) fold,
// mirror or collapse the template's outline; a real one keeps it a convex quadrilateral of sane size.
#pragma once

#include <Eigen/Core>
#include <array>

namespace heel {

using Outline = std::array<Eigen::Vector2d, 4>;  ///< px, in order round the region

struct ShapeLimits {
  double scale_min = 0.1;  ///< square root of the area ratio, current to reference
  double scale_max = 10.0;
  double squeeze_min = 0.2;      ///< shorter to longer axis of a small circle's image: the cosine of the tilt
  double depth_ratio_max = 4.0;  ///< farthest to nearest corner of the outline
};

bool plausible_shape(const Eigen::Matrix3d& H_cur_from_ref, const Outline& outline_ref_px,
                     const ShapeLimits& limits);

/// How much H magnifies near a point: the square root of |d cur / d ref|.
double local_scale(const Eigen::Matrix3d& H_cur_from_ref, const Eigen::Vector2d& ref_px);

}  // namespace heel
