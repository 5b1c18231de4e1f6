// From matches to the homography of the template's plane, and whether it can be a view of the shirt.
// Convention: x_cur ~ H_cur_from_ref x_ref, undistorted pixels.
#pragma once

#include <Eigen/Core>
#include <span>

#include "heel/flow.h"
#include "heel/homography.h"
#include "heel/matching.h"
#include "heel/vision_config.h"
#include "vision/homography/shape_plausibility.h"
#include "vision/matching/feature_grid.h"
#include "vision/matching/template_matcher.h"
#include "vision/pose/pose_workspace.h"
#include "vision/template/reference_view.h"

namespace heel {

/// What a frame says about the template's plane. The spans are views of the work space: they are valid until
/// the next fit.
struct PlaneFit {
  PoseReason reason = PoseReason::NoHomography;  ///< Found, or why this is not taken for the shirt
  Eigen::Matrix3d H_cur_from_ref = Eigen::Matrix3d::Zero();
  std::span<const Match> inlier_matches;  ///< that support H
  std::span<const PointPair> inliers;     ///< the same as undistorted pixels
  double certainty = 0.0;                 ///< inliers / features of the template

  bool found() const { return reason == PoseReason::Found; }
};

class PlaneFitter {
 public:
  /// `reference` must outlive this. Memory is taken once.
  PlaneFitter(const ReferenceView& reference, const ShapeLimits& shape_limits, const VisionConfig& config);

  /// The homography that most matches support. Not found: NoHomography, TooFewInliers or ImplausibleShape.
  PlaneFit fit(std::span<const Match> matches, const FeatureGrid& frame, PoseWorkspace& work);

  /// Matches again near where `first` puts the features, and fits those: more pairs, mainly towards the
  /// edges, so a more precise homography. The error of `first` at the edges may exceed the matcher's radius;
  /// then a second round starts from a better homography. Only now, with all pairs there are, is the
  /// certainty compared with its minimum. `first` must be found. If no homography is found again, the last
  /// one is returned, with the reason.
  PlaneFit fit_guided(const PlaneFit& first, TemplateMatcher& matcher, const FeatureGrid& frame,
                      PoseWorkspace& work);

  /// A plausible view of the shirt's outline.
  bool plausible(const Eigen::Matrix3d& H_cur_from_ref) const;

 private:
  PlaneFit fit_homography(std::span<const Match> matches, const FeatureGrid& frame, PoseWorkspace& work);
  PlaneFit checked_shape(PlaneFit fit, const FeatureGrid& frame, PoseWorkspace& work) const;
  bool feature_scales_agree(const PlaneFit& fit, const FeatureGrid& frame, PoseWorkspace& work) const;
  double outline_moved_px(const Eigen::Matrix3d& H_before, const Eigen::Matrix3d& H_after) const;
  std::span<const PredictedFeature> predict(const Eigen::Matrix3d& H_cur_from_ref, PoseWorkspace& work) const;

  const ReferenceView& reference_;
  ShapeLimits shape_limits_;
  int min_inliers_;
  double min_certainty_;
  HomographyEstimator homography_estimator_;
};

}  // namespace heel
