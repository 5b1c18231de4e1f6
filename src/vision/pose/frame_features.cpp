#include "vision/pose/frame_features.h"

#include "heel/stage_times.h"
#include "vision/matching/guided_matcher.h"

namespace heel {

FrameFeatures::Found::Found(int max_features) : grid(max_features, GuidedMatchSettings{}.radius_px) {
  undistorted_px.reserve(static_cast<std::size_t>(max_features));
}

FrameFeatures::FrameFeatures(const CameraModel& camera, const FeatureSettings& settings,
                             int closer_look_features)
    : camera_(camera),
      settings_(settings),
      closer_look_features_(closer_look_features),
      extractor_(camera.width_px, camera.height_px, settings),
      found_{Found(settings.max_features), Found(settings.max_features), Found(settings.max_features)} {
  for (Found& found : found_) extractor_.reserve(found.features);
}

const FeatureGrid& FrameFeatures::find(const FrameView& frame, const ExpectedView& expected, Search search) {
  FeatureSettings settings = settings_;
  if (search == Search::CloserLook) settings.max_features = closer_look_features_;
  settings.sigma_min_px = static_cast<float>(expected.sigma_min_px);
  settings.sigma_max_px = static_cast<float>(expected.sigma_max_px);
  settings.upsample = expected.upsample;
  extractor_.set_settings(settings);
  Found& found = found_[static_cast<std::size_t>(search)];
  extractor_.extract(frame, expected.region, found.features);
  found.undistorted_px.clear();
  for (const Feature& feature : found.features.features)
    found.undistorted_px.push_back(
        camera_.undistort_px({static_cast<double>(feature.x_px), static_cast<double>(feature.y_px)}));
  found.grid.assign(found.features, found.undistorted_px);
  mark(times_, VisionStage::Undistortion);
  return found.grid;
}

void FrameFeatures::report_stage_times(StageTimes* times) {
  times_ = times;
  extractor_.report_stage_times(times);
}

}  // namespace heel
