// From a rough pose to pairs that fit: the frame's features near it are matched with those of the view that
// is most like it, and the pose is solved for them, several times with a smaller radius.
//
// Units: undistorted pixels.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "heel/camera_model.h"
#include "heel/homography.h"
#include "vision/matching/feature_grid.h"
#include "vision/matching/guided_matcher.h"
#include "vision/pose/back_surface.h"
#include "vision/pose/surface_pose_solver.h"
#include "vision/pose/template_view.h"

namespace heel {

struct ConfirmedView {
  FrontalMotion motion;
  std::span<const PointPair> pairs;  ///< that fit: reference and current view; valid until the next call
  std::size_t view_features = 0;     ///< of the view they were matched with
};

class ViewConfirmer {
 public:
  /// `views` must outlive this; at least one. Memory is taken once.
  ViewConfirmer(std::span<const TemplateView> views, const BackSurface& surface,
                const CameraModel& reference_camera, const CameraModel& current_camera,
                int max_frame_features);

  /// `magnification` of the picture in which the features were found: 2 for an upsampled one. Nothing: too
  /// few features match.
  std::optional<ConfirmedView> confirm(const FrontalMotion& candidate, const FeatureGrid& frame,
                                       double magnification);

 private:
  std::span<const PredictedFeature> predict(const TemplateView& view, const FrontalMotion& motion);

  std::span<const TemplateView> views_;
  BackSurface surface_;
  Eigen::Matrix3d K_ref_inverse_, K_cur_;
  double focal_ratio_;     // current to reference
  double region_side_px_;  // the longer one, in the reference view
  GuidedMatcher matcher_;
  SurfacePoseSolver solver_;
  // Work space: written and read within one call.
  std::vector<PredictedFeature> predicted_;
  std::vector<Match> matches_;
  std::vector<SurfaceObservation> observations_;
  std::vector<PointPair> pairs_;
};

}  // namespace heel
