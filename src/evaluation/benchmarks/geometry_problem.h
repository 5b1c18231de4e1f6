// Made matches between two views of a back: true pairs with a pixel of noise, and wrong ones.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <opencv2/core/types.hpp>
#include <vector>

#include "heel/homography.h"

namespace heel::evaluation {

struct GeometryProblem {
  std::vector<PointPair> pairs;       ///< in random order
  std::vector<cv::Point2f> ref, cur;  ///< the same for OpenCV
  Eigen::Matrix3d A_cur_from_ref;     ///< K⁻¹ H K of the truth
  Eigen::Matrix3d H_cur_from_ref;     ///< the truth

  /// How far `H` moves the region's corners from where they are, on average, px of the current view.
  double corner_error_px(const Eigen::Matrix3d& H) const;
};

/// 200 pairs, half of them wrong. A seed, a problem.
GeometryProblem make_geometry_problem(std::uint64_t seed);

}  // namespace heel::evaluation
