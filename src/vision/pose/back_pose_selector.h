// Steps 7 and 8's last part: from a motion of the plane to the pose of the back that was seen, be it curved,
// as backs are, or flat, as a picture or a board held up.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "heel/homography.h"
#include "heel/motion.h"
#include "heel/vision_config.h"
#include "vision/matching/feature_grid.h"
#include "vision/matching/template_matcher.h"
#include "vision/pose/back_surface.h"
#include "vision/pose/curved_surface_refiner.h"
#include "vision/pose/motion_refine.h"
#include "vision/template/reference_view.h"

namespace heel {

/// What both poses start from: the homography's inliers, and a motion of the plane that explains them.
struct PlaneSolution {
  std::span<const PointPair> inliers;  ///< undistorted pixels
  Eigen::Matrix3d H_cur_from_ref;
  PlaneMotion motion;
};

class BackPoseSelector {
 public:
  /// Without a distance of the reference view the back's curvature has no scale: then it is a plane, and its
  /// deviations are those of pixels alone. `reference` is to outlive this. Memory is taken once.
  BackPoseSelector(const ReferenceView& reference, const Eigen::Matrix3d& K_cur, const VisionConfig& config);

  BackPoseSelector(const BackPoseSelector&) = delete;
  BackPoseSelector& operator=(const BackPoseSelector&) = delete;

  FrontalPose estimate(const PlaneSolution& seen, TemplateMatcher& matcher, const FeatureGrid& frame);

 private:
  Eigen::Matrix3d K_ref_, K_cur_;
  Eigen::Vector2d centre_px_;
  BackSurface flat_, curved_;
  FrontalPoseEstimator frontal_estimator_;
  CurvedSurfaceRefiner surface_refiner_;
};

}  // namespace heel
