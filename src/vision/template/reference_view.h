// The reference view: the template, prepared for the steps of vision.
//
// Convention: the plane z = d in the reference camera, normal (0,0,1). Units: undistorted pixels, metres.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "heel/features.h"
#include "heel/shirt_template.h"
#include "heel/vision_config.h"
#include "vision/homography/shape_plausibility.h"

namespace heel {

struct ReferenceView {
  /// Throws heel::Error if the template has no camera, or too few features to be followed.
  ReferenceView(const ShirtTemplate& shirt, const VisionConfig& config);

  FeatureSet set;
  std::vector<Eigen::Vector2d> px;  ///< undistorted, one for each feature
  Outline outline_px;               ///< the region's undistorted corners, clockwise from the top left
  Eigen::Vector2d centre_px;        ///< undistorted centre of the region
  Eigen::Matrix3d K, K_inverse;
  double distance_m = 0.0;  ///< 0: unknown
};

/// Throws heel::Error if the camera has no size or focal length; `whose` names it in the message.
void require_camera(const CameraModel& camera, const char* whose);

}  // namespace heel
