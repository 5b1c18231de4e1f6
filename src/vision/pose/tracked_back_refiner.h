// While tracking: the pose of the back from the last frame's. Patches of the whole print confirm it; so the
// minima of the plane's pose need not be found and compared in each frame, and the pose stays in the minimum
// in which it was.
//
// Convention: X_cur / d = R_cur_from_ref X_ref / d + t_over_d. Units: undistorted pixels, t/d.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "vision/matching/template_matcher.h"
#include "vision/pose/back_pose.h"
#include "vision/pose/back_surface.h"
#include "vision/pose/surface_matcher.h"
#include "vision/pose/surface_pose_refiner.h"
#include "vision/pose/surface_pose_solver.h"
#include "vision/template/reference_view.h"

namespace heel {

class TrackedBackRefiner {
 public:
  /// `surface_matcher` and `patch_refiner` must outlive this. Memory is taken once.
  TrackedBackRefiner(const ReferenceView& reference, const Eigen::Matrix3d& K_cur,
                     SurfaceMatcher& surface_matcher, SurfacePoseRefiner& patch_refiner);

  /// From `last`, the motion of the last frame. Nothing: too few patches are where the pose puts them, or the
  /// homography explains the frame so well that the back may be a plane.
  std::optional<BackPose> refine(const BackSurface& surface, const FrontalMotion& last,
                                 const PlaneSolution& plane, TemplateMatcher& matcher,
                                 const FrameContent& frame);

 private:
  FrontalMotion last_motion_fitted_to_inliers(const BackSurface& surface, const FrontalMotion& last,
                                              std::span<const PointPair> inliers);
  double explanation_by(const BackSurface& surface, const FrontalMotion& motion) const;

  Eigen::Matrix3d K_ref_inverse_, K_cur_;
  SurfaceMatcher& surface_matcher_;
  SurfacePoseRefiner& patch_refiner_;
  SurfacePoseSolver solver_;
  // Work space: written and read within one call.
  std::vector<SurfaceObservation> observations_;
  std::vector<PointPair> pairs_;
};

}  // namespace heel
