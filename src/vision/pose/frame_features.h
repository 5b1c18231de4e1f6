// The features of a frame, where and at which sizes the shirt is expected, with their undistorted places.
// Those of the whole frame are kept while parts of it are searched.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "heel/camera_model.h"
#include "heel/features.h"
#include "heel/pose_estimator.h"
#include "vision/matching/feature_grid.h"

namespace heel {

class FrameFeatures {
 public:
  enum class Search : std::size_t { WholeFrame, ExpectedView, CloserLook };

  /// Memory is taken once, for frames of the camera's size and `settings.max_features`. A closer look, whose
  /// region is little larger than a back, finds at most `closer_look_features` of them.
  FrameFeatures(const CameraModel& camera, const FeatureSettings& settings, int closer_look_features);

  FrameFeatures(const FrameFeatures&) = delete;
  FrameFeatures& operator=(const FrameFeatures&) = delete;

  const FeatureSettings& settings() const { return settings_; }

  /// Valid until the next call with the same `search`.
  const FeatureGrid& find(const FrameView& frame, const ExpectedView& expected, Search search);

  /// The features that the last such search has found.
  const FeatureGrid& last(Search search) const { return found_[static_cast<std::size_t>(search)].grid; }

  /// As PoseEstimator.
  void report_stage_times(StageTimes* times);

 private:
  struct Found {
    explicit Found(int max_features);

    FeatureSet features;
    std::vector<Eigen::Vector2d> undistorted_px;
    FeatureGrid grid;
  };

  CameraModel camera_;
  FeatureSettings settings_;
  int closer_look_features_;
  FeatureExtractor extractor_;
  std::array<Found, 3> found_;  // by Search
  StageTimes* times_ = nullptr;
};

}  // namespace heel
