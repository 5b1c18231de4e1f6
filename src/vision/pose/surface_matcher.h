// Features of the frame near where a pose of the curved surface puts those of the template.
//
// Convention: X_cur / d = R_cur_from_ref X_ref / d + t_over_d. Units: undistorted pixels.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "heel/homography.h"
#include "vision/matching/feature_grid.h"
#include "vision/matching/template_matcher.h"
#include "vision/pose/back_surface.h"
#include "vision/pose/frontal_pose_estimator.h"

namespace heel {

class SurfaceMatcher {
 public:
  /// `reference_px`: the template's features, undistorted, in the matcher's order; they must outlive this.
  /// Memory is taken once.
  SurfaceMatcher(std::span<const Eigen::Vector2d> reference_px, const Eigen::Matrix3d& K_ref_inverse,
                 const Eigen::Matrix3d& K_cur);

  /// Fills `out` with the matches whose whitened residual is below `limit_px`; its noise is 1 px where that
  /// of features is 1 px in both images.
  void match(const BackSurface& surface, const FrontalMotion& motion, double limit_px,
             TemplateMatcher& matcher, const FeatureGrid& frame, std::vector<PointPair>& out);

 private:
  void predict(const BackSurface& surface, const FrontalMotion& motion);

  std::span<const Eigen::Vector2d> reference_px_;
  Eigen::Matrix3d K_ref_inverse_, K_cur_;
  // Work space: written and read within one call.
  std::vector<PredictedFeature> predicted_;
  std::vector<Eigen::Matrix2d> cur_from_ref_;  ///< derivative of the image, for each predicted feature
};

}  // namespace heel
