// The extractor behind heel/features.h: integral image → fast-Hessian → selection → orientation → descriptor.
#include <algorithm>
#include <cstdint>
#include <numeric>
#include <string>
#include <vector>

#include "heel/error.h"
#include "heel/features.h"
#include "vision/descriptor.h"
#include "vision/fast_hessian.h"
#include "vision/integral_image.h"
#include "vision/keypoint_selection.h"
#include "vision/orientation.h"

namespace heel {
namespace {

// Keypoints kept before spreading, for each one wanted: enough that weak corners of the image are still in.
constexpr int kCandidatesPerFeature = 4;

Region clipped(const Region& region, int width_px, int height_px) {
  if (region.width_px == 0 && region.height_px == 0) return {0, 0, width_px, height_px};
  const int x0 = std::clamp(region.x_px, 0, width_px), y0 = std::clamp(region.y_px, 0, height_px);
  const int x1 = std::clamp(region.x_px + region.width_px, x0, width_px);
  const int y1 = std::clamp(region.y_px + region.height_px, y0, height_px);
  return {x0, y0, x1 - x0, y1 - y0};
}

void check(const FeatureSettings& settings) {
  if (settings.octaves < 1 || settings.octaves > kMaxOctaves)
    throw Error("features: octaves " + std::to_string(settings.octaves) + " is out of range (expected 1…4)");
  if (settings.max_features < 1)
    throw Error("features: max_features " + std::to_string(settings.max_features) +
                " is out of range (expected 1 or more)");
}

}  // namespace

struct FeatureExtractor::Impl {
  Impl(int width_px, int height_px, const FeatureSettings& given)
      : settings(given),
        max_width_px(width_px),
        max_height_px(height_px),
        max_features(given.max_features),
        integral(width_px, height_px),
        hessian(width_px),
        selection(static_cast<std::size_t>(given.max_features) * kCandidatesPerFeature) {
    downwards.reserve(static_cast<std::size_t>(given.max_features));
  }

  void describe_all(FeatureSet& out);

  FeatureSettings settings;
  int max_width_px, max_height_px;
  int max_features;  // memory is there for so many
  IntegralImage integral;
  FastHessian hessian;
  KeypointSelection selection;
  std::vector<std::uint32_t> downwards;  // the features found, from the top of the image
  StageTimes* times = nullptr;
};

/// From the top of the image downwards, so that the part of the integral image that is read stays in cache;
/// from the strongest on it would be somewhere else every time.
void FeatureExtractor::Impl::describe_all(FeatureSet& out) {
  downwards.resize(out.features.size());
  std::iota(downwards.begin(), downwards.end(), 0U);
  std::sort(downwards.begin(), downwards.end(),
            [&](std::uint32_t a, std::uint32_t b) { return out.features[a].y_px < out.features[b].y_px; });
  out.descriptors.resize(out.features.size());
  for (const std::uint32_t i : downwards) {
    Feature& feature = out.features[i];
    if (settings.oriented) feature.angle_rad = dominant_orientation(integral, feature);
    describe(integral, feature, !settings.oriented, out.descriptors[i]);
  }
}

FeatureExtractor::FeatureExtractor(int max_width_px, int max_height_px, const FeatureSettings& settings) {
  check(settings);
  if (max_width_px < 1 || max_height_px < 1)
    throw Error("features: image size " + std::to_string(max_width_px) + "×" + std::to_string(max_height_px) +
                " is empty");
  impl_ = std::make_unique<Impl>(max_width_px, max_height_px, settings);
}

FeatureExtractor::~FeatureExtractor() = default;
FeatureExtractor::FeatureExtractor(FeatureExtractor&&) noexcept = default;
FeatureExtractor& FeatureExtractor::operator=(FeatureExtractor&&) noexcept = default;

const FeatureSettings& FeatureExtractor::settings() const {
  return impl_->settings;
}

void FeatureExtractor::set_settings(const FeatureSettings& settings) {
  impl_->settings = settings;
  impl_->settings.octaves = std::clamp(settings.octaves, 1, kMaxOctaves);
  impl_->settings.max_features = std::clamp(settings.max_features, 1, impl_->max_features);
}

void FeatureExtractor::measure(StageTimes* times) {
  impl_->times = times;
}

void FeatureExtractor::reserve(FeatureSet& out) const {
  out.features.reserve(static_cast<std::size_t>(impl_->max_features));
  out.descriptors.reserve(static_cast<std::size_t>(impl_->max_features));
}

void FeatureExtractor::extract(const FrameView& frame, const Region& region, FeatureSet& out) {
  Impl& s = *impl_;
  out.features.clear();
  out.descriptors.clear();
  const int width_px = static_cast<int>(frame.header.width_px);
  const int height_px = static_cast<int>(frame.header.height_px);
  if (width_px > s.max_width_px || height_px > s.max_height_px)
    throw Error("features: a frame of " + std::to_string(width_px) + "×" + std::to_string(height_px) +
                " is larger than the " + std::to_string(s.max_width_px) + "×" +
                std::to_string(s.max_height_px) + " prepared for");
  const Region searched = clipped(region, width_px, height_px);
  if (frame.grey == nullptr || searched.width_px == 0 || searched.height_px == 0) return;

  s.integral.compute(frame);
  mark(s.times, VisionStage::Integral);
  s.selection.start(s.settings.threshold);
  s.hessian.detect(s.integral, searched, s.settings, s.selection);
  mark(s.times, VisionStage::Hessian);
  const auto wanted = static_cast<std::size_t>(s.settings.max_features);
  if (s.settings.spread) {
    s.selection.strongest_spread(wanted, searched, out.features);
  } else {
    s.selection.strongest(wanted, out.features);
  }
  mark(s.times, VisionStage::Selection);
  s.describe_all(out);
  mark(s.times, VisionStage::Description);
}

}  // namespace heel
