// Where in a frame the back may be, by the features of all views of the template: each match votes for a
// place and a size of the back, and votes that agree make a candidate. Few of the matches need be right.
//
// Units: undistorted pixels of the frame.
// Source: D. Lowe, "Distinctive Image Features from Scale-Invariant Keypoints", IJCV 60(2), 2004,
// section 7.3.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "heel/camera_model.h"
#include "heel/matching.h"
#include "vision/matching/feature_grid.h"
#include "vision/pose/back_surface.h"
#include "vision/pose/surface_pose_solver.h"
#include "vision/pose/template_view.h"

namespace heel {

class ViewVoter {
 public:
  /// `views` must outlive this. Memory is taken once.
  ViewVoter(std::span<const TemplateView> views, const BackSurface& surface,
            const CameraModel& reference_camera, const CameraModel& current_camera, int max_frame_features);

  /// Rough poses, best supported first, valid until the next call.
  std::span<const FrontalMotion> candidates(const FeatureGrid& frame);

 private:
  struct Vote {
    Eigen::Vector2d centre_px;  ///< of the back
    double log_scale;           ///< of the back, frame to reference
    double reach_px;            ///< places of the back that differ by less agree
    double yaw_rad;             ///< of the view
    Eigen::Vector3d ray;        ///< of the reference view
    Eigen::Vector2d cur_px;
    bool used;
  };

  void cast_votes(const FeatureGrid& frame);
  static bool agree(const Vote& seed, const Vote& other);
  double support(const Vote& seed) const;
  FrontalMotion candidate_of(const Vote& seed);

  std::span<const TemplateView> views_;
  BackSurface surface_;
  Eigen::Matrix3d K_ref_inverse_, K_cur_inverse_;
  double focal_ratio_;                                // current to reference
  double region_side_px_;                             // the longer one, in the reference view
  FeatureSet view_features_;                          // of all views
  std::vector<std::size_t> view_of_, index_in_view_;  // of each of them
  Matcher matcher_;
  SurfacePoseSolver solver_;
  // Work space: written and read within one call.
  std::vector<Match> matches_;
  std::vector<Vote> votes_;
  std::vector<SurfaceObservation> observations_;
  std::vector<FrontalMotion> candidates_;
};

}  // namespace heel
