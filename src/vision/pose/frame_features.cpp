#include "vision/pose/frame_features.h"

#include "heel/stage_times.h"
#include "vision/matching/guided_matcher.h"

namespace heel {

FrameFeatures::FrameFeatures(const CameraModel& camera, const FeatureSettings& settings)
    : camera_(camera),
      extractor_(camera.width_px, camera.height_px, settings),
      grid_(settings.max_features, GuidedMatchSettings{}.radius_px) {
  extractor_.reserve(features_);
  undistorted_px_.reserve(static_cast<std::size_t>(settings.max_features));
}

const FeatureGrid& FrameFeatures::find(const FrameView& frame, const ExpectedView& expected) {
  FeatureSettings settings = extractor_.settings();
  settings.sigma_min_px = static_cast<float>(expected.sigma_min_px);
  settings.sigma_max_px = static_cast<float>(expected.sigma_max_px);
  settings.upsample = expected.upsample;
  extractor_.set_settings(settings);
  extractor_.extract(frame, expected.region, features_);
  undistorted_px_.clear();
  for (const Feature& feature : features_.features)
    undistorted_px_.push_back(
        camera_.undistort_px({static_cast<double>(feature.x_px), static_cast<double>(feature.y_px)}));
  grid_.assign(features_, undistorted_px_);
  mark(times_, VisionStage::Undistortion);
  return grid_;
}

void FrameFeatures::measure(StageTimes* times) {
  times_ = times;
  extractor_.measure(times);
}

}  // namespace heel
