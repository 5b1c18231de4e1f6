// Finds the back where the template's own features do not: turned far, small, or pale. Views of the template
// vote for candidates; each is looked at closely, matched with the view that is most like it, and confirmed
// by patches of the whole print.
//
// Convention: X_cur = R_cur_from_ref X_ref + t. Units: undistorted pixels, t/d.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "heel/camera_model.h"
#include "heel/flow.h"
#include "heel/shirt_template.h"
#include "heel/vision_config.h"
#include "vision/homography/shape_plausibility.h"
#include "vision/pose/back_surface.h"
#include "vision/pose/frame_features.h"
#include "vision/pose/frontal_pose_estimator.h"
#include "vision/pose/surface_pose_refiner.h"
#include "vision/pose/template_view.h"
#include "vision/pose/view_confirmer.h"
#include "vision/pose/view_predictor.h"
#include "vision/pose/view_voter.h"
#include "vision/template/reference_view.h"

namespace heel {

/// Features of a frame, and how much the picture was enlarged in which they were found.
struct MagnifiedFeatures {
  const FeatureGrid& grid;
  double magnification;  ///< 1, or UpsampledRegion::kFactor
};

/// Of the features found where `expected` says.
MagnifiedFeatures magnified(const FeatureGrid& grid, const ExpectedView& expected);

/// A back that a view of the template has shown.
struct ViewDetection {
  PoseReason reason = PoseReason::NoHomography;  ///< Found, or the gate that the last candidate did not pass
  FrontalPose pose;
  Eigen::Matrix3d H_cur_from_ref = Eigen::Matrix3d::Zero();
  std::uint32_t inliers = 0;
  std::uint32_t view_features = 0;
  double certainty = 0.0;  ///< inliers / features of the view

  bool found() const { return reason == PoseReason::Found; }
};

class ViewSearch {
 public:
  /// `reference`, `predictor`, `features` and `patch_refiner` must outlive this. Memory is taken once. A
  /// `surface` that is flat has no views: then nothing is ever found.
  ViewSearch(const ShirtTemplate& shirt, const ReferenceView& reference, const CameraModel& camera,
             const VisionConfig& config, const BackSurface& surface, const ShapeLimits& shape_limits,
             const ViewPredictor& predictor, FrameFeatures& features, SurfacePoseRefiner& patch_refiner);

  ViewSearch(const ViewSearch&) = delete;
  ViewSearch& operator=(const ViewSearch&) = delete;

  /// `found`: of `frame`; not those of a closer look, which are replaced.
  ViewDetection search(const FrameView& frame, const MagnifiedFeatures& found);

 private:
  ViewDetection confirm(const FrameView& frame, const MagnifiedFeatures& found,
                        const FrontalMotion& candidate);
  std::optional<SurfacePose> refine_mirrored(const FrameView& frame, const MagnifiedFeatures& features,
                                             const SurfacePose& pose);
  bool plausible(const Eigen::Matrix3d& H_cur_from_ref) const;

  const ReferenceView& reference_;
  const ViewPredictor& predictor_;
  FrameFeatures& features_;
  SurfacePoseRefiner& patch_refiner_;
  BackSurface surface_;
  ShapeLimits shape_limits_;
  Eigen::Matrix3d K_cur_;
  std::uint32_t min_inliers_;
  double min_certainty_;
  std::vector<TemplateView> views_;
  ViewVoter voter_;
  ViewConfirmer confirmer_;
};

}  // namespace heel
