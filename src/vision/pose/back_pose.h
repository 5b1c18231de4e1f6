// What the last step is given, and its answer.
//
// Convention: X_cur = R_cur_from_ref X_ref + t. Units: undistorted pixels, t/d.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>

#include "heel/flow.h"
#include "heel/homography.h"
#include "heel/motion.h"
#include "vision/matching/feature_grid.h"
#include "vision/pose/frontal_pose_estimator.h"

namespace heel {

/// The inliers of the homography, and a motion of the plane that explains them.
struct PlaneSolution {
  std::span<const PointPair> inliers;  ///< undistorted pixels
  Eigen::Matrix3d H_cur_from_ref;
  PlaneMotion motion;
};

/// What a frame shows: the picture and its features.
struct FrameContent {
  const FrameView& view;
  const FeatureGrid& features;
};

struct BackPose {
  FrontalPose pose;
  std::size_t pairs = 0;  ///< features that fit it
};

}  // namespace heel
