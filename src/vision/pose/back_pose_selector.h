// From a motion of the template's plane to the pose of the back: of a curved surface, as backs are, or of a
// plane, as a picture or a board is. Features say whether it may be a plane, patches of the whole print
// whether it is one.
//
// Convention: X_cur = R_cur_from_ref X_ref + t. Units: undistorted pixels, t/d.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "heel/flow.h"
#include "heel/homography.h"
#include "heel/motion.h"
#include "heel/vision_config.h"
#include "vision/matching/feature_grid.h"
#include "vision/matching/template_matcher.h"
#include "vision/pose/back_pose.h"
#include "vision/pose/back_surface.h"
#include "vision/pose/curved_surface_refiner.h"
#include "vision/pose/frontal_pose_estimator.h"
#include "vision/pose/surface_matcher.h"
#include "vision/pose/surface_pose_refiner.h"
#include "vision/pose/tracked_back_refiner.h"
#include "vision/template/reference_view.h"

namespace heel {

class BackPoseSelector {
 public:
  /// `reference` and `patch_refiner` must outlive this. If the template's distance is unknown, the curvature
  /// in units of the distance is unknown, too: then the back is modelled as a plane, and sigmas include the
  /// noise of pixels only. Memory is taken once.
  BackPoseSelector(const ReferenceView& reference, const Eigen::Matrix3d& K_cur, const VisionConfig& config,
                   SurfacePoseRefiner& patch_refiner);

  const BackSurface& curved_surface() const { return curved_; }

  BackPoseSelector(const BackPoseSelector&) = delete;
  BackPoseSelector& operator=(const BackPoseSelector&) = delete;

  /// `patch_rounds`: see SurfacePoseRefiner::refine.
  BackPose estimate(const PlaneSolution& plane, TemplateMatcher& matcher, const FrameContent& frame,
                    int patch_rounds);

  /// The same, of the frame after the one in which the motion was `last`.
  BackPose estimate_next(const FrontalMotion& last, const PlaneSolution& plane, TemplateMatcher& matcher,
                         const FrameContent& frame);

 private:
  Eigen::Matrix3d K_ref_, K_cur_;
  Eigen::Vector2d centre_px_;
  BackSurface flat_, curved_;
  FrontalPoseEstimator frontal_estimator_;
  SurfaceMatcher surface_matcher_;
  CurvedSurfaceRefiner surface_refiner_;
  SurfacePoseRefiner& patch_refiner_;
  TrackedBackRefiner tracked_refiner_;
};

}  // namespace heel
