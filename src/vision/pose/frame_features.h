// The features of a frame, where and at which sizes the shirt is expected, with their undistorted places.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "heel/camera_model.h"
#include "heel/features.h"
#include "heel/pose_estimator.h"
#include "vision/matching/feature_grid.h"

namespace heel {

class FrameFeatures {
 public:
  /// Memory is taken once, for frames of the camera's size and `settings.max_features`.
  FrameFeatures(const CameraModel& camera, const FeatureSettings& settings);

  const FeatureSettings& settings() const { return extractor_.settings(); }

  /// Valid until the next call.
  const FeatureGrid& find(const FrameView& frame, const ExpectedView& expected);

  /// As PoseEstimator.
  void measure(StageTimes* times);

 private:
  CameraModel camera_;
  FeatureExtractor extractor_;
  FeatureSet features_;
  std::vector<Eigen::Vector2d> undistorted_px_;
  FeatureGrid grid_;
  StageTimes* times_ = nullptr;
};

}  // namespace heel
