// Whether a frame shows the shirt at a second place, too: on another person, a poster, the back of a chair.
// The picture cannot tell which of them is the person, so such a frame is refused.
//
// Units: undistorted pixels of the frame.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "heel/features.h"
#include "heel/flow.h"
#include "vision/homography/shape_plausibility.h"
#include "vision/matching/feature_grid.h"
#include "vision/matching/template_matcher.h"
#include "vision/pose/plane_fitter.h"
#include "vision/pose/pose_workspace.h"
#include "vision/pose/view_search.h"
#include "vision/template/reference_view.h"

namespace heel {

class SecondPlaceSearch {
 public:
  /// All of them must outlive this. Memory is taken once, for `max_frame_features`.
  SecondPlaceSearch(const ReferenceView& reference, TemplateMatcher& matcher, PlaneFitter& plane_fitter,
                    ViewSearch& view_search, int max_frame_features);

  SecondPlaceSearch(const SecondPlaceSearch&) = delete;
  SecondPlaceSearch& operator=(const SecondPlaceSearch&) = delete;

  /// Searches once more, as for the first place, with the features outside of `found`, a pose in `frame`. A
  /// second place counts if it could be followed by itself, or has at least half of the certainty of `found`.
  bool shows_second_place(const FrameView& frame, const FeatureGrid& features, const PoseEstimate& found,
                          PoseWorkspace& work);

 private:
  const FeatureGrid& features_outside(const Outline& place, const FeatureGrid& features);

  const ReferenceView& reference_;
  TemplateMatcher& matcher_;
  PlaneFitter& plane_fitter_;
  ViewSearch& view_search_;
  // Work space: written and read within one call.
  FeatureSet outside_;
  std::vector<Eigen::Vector2d> outside_px_;
  FeatureGrid grid_;
};

}  // namespace heel
