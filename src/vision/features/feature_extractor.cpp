// The extractor of heel/features.h: (upsampling →) integral image → fast-Hessian → selection → orientation →
// descriptor.
#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "heel/error.h"
#include "heel/features.h"
#include "vision/features/descriptor.h"
#include "vision/features/fast_hessian.h"
#include "vision/features/integral_image.h"
#include "vision/features/keypoint_selection.h"
#include "vision/features/orientation.h"
#include "vision/features/upsampled_region.h"

namespace heel {
namespace {

// Keypoints kept during detection for each one wanted: enough to leave some in weakly textured corners of the
// image.
constexpr int kCandidatesPerFeature = 4;

Region clipped(const Region& region, int width_px, int height_px) {
  if (region.width_px == 0 && region.height_px == 0) return {0, 0, width_px, height_px};
  const int x0 = std::clamp(region.x_px, 0, width_px), y0 = std::clamp(region.y_px, 0, height_px);
  const int x1 = std::clamp(region.x_px + region.width_px, x0, width_px);
  const int y1 = std::clamp(region.y_px + region.height_px, y0, height_px);
  return {x0, y0, x1 - x0, y1 - y0};
}

/// Inside the image.
Region with_border(const Region& region, int border_px, int width_px, int height_px) {
  return clipped({region.x_px - border_px, region.y_px - border_px, region.width_px + 2 * border_px,
                  region.height_px + 2 * border_px},
                 width_px, height_px);
}

/// How far from the centre of a feature its detection, orientation and description read the image.
int reach_px(const FeatureSettings& settings) {
  const float largest_px = std::min(settings.sigma_max_px, largest_sigma_px(settings.octaves));
  return std::max(FastHessian::reach_px(settings.octaves),
                  descriptor_reach_px(largest_px, !settings.oriented));
}

void check_settings(const FeatureSettings& settings) {
  if (settings.octaves < 1 || settings.octaves > kMaxOctaves)
    throw Error("features: octaves " + std::to_string(settings.octaves) + " is out of range (expected 1…4)");
  if (settings.max_features < 1)
    throw Error("features: max_features " + std::to_string(settings.max_features) +
                " is out of range (expected 1 or more)");
}

}  // namespace

struct FeatureExtractor::Impl {
  struct Height {
    float y_px;
    std::uint32_t feature;  // its place in the set
  };

  Impl(int width_px, int height_px, const FeatureSettings& given)
      : settings(given),
        max_width_px(width_px),
        max_height_px(height_px),
        max_features(given.max_features),
        upsampled(width_px, static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px)),
        integral(width_px,
                 UpsampledRegion::kFactor * height_px),  // an upsampled region may be taller than a frame
        hessian(width_px),
        selection(static_cast<std::size_t>(given.max_features) * kCandidatesPerFeature) {
    top_down.reserve(static_cast<std::size_t>(given.max_features));
  }

  void extract(const FrameView& view, const Region& region, const FeatureSettings& wanted, FeatureSet& out);
  void extract_upsampled(const FrameView& frame, const Region& region, const Region& part, FeatureSet& out);
  void describe_all(FeatureSet& out);

  FeatureSettings settings;
  int max_width_px, max_height_px;
  int max_features;  // memory is taken for this many
  UpsampledRegion upsampled;
  IntegralImage integral;
  FastHessian hessian;
  KeypointSelection selection;
  std::vector<Height> top_down;  // the features found, in the order of y
  StageTimes* times = nullptr;
};

/// In the order of y, not of strength, so that the part of the integral image that is read stays in the
/// cache.
void FeatureExtractor::Impl::describe_all(FeatureSet& out) {
  top_down.clear();
  for (std::uint32_t i = 0; i < out.features.size(); ++i) top_down.push_back({out.features[i].y_px, i});
  std::sort(top_down.begin(), top_down.end(),
            [](const Height& a, const Height& b) { return a.y_px < b.y_px; });
  out.descriptors.resize(out.features.size());
  for (const Height& height : top_down) {
    Feature& feature = out.features[height.feature];
    if (settings.oriented) feature.angle_rad = dominant_orientation(integral, feature);
    describe(integral, feature, !settings.oriented, out.descriptors[height.feature]);
  }
}

FeatureExtractor::FeatureExtractor(int max_width_px, int max_height_px, const FeatureSettings& settings) {
  check_settings(settings);
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

void FeatureExtractor::report_stage_times(StageTimes* times) {
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
  const Region part = with_border(searched, UpsampledRegion::kBorder_px, width_px, height_px);
  if (s.settings.upsample && s.upsampled.has_room_for(part))
    return s.extract_upsampled(frame, searched, part, out);
  s.extract(frame, searched, s.settings, out);
}

void FeatureExtractor::Impl::extract(const FrameView& view, const Region& region,
                                     const FeatureSettings& wanted, FeatureSet& out) {
  integral.compute(view, with_border(region, reach_px(wanted), static_cast<int>(view.header.width_px),
                                     static_cast<int>(view.header.height_px)));
  mark(times, VisionStage::Integral);
  selection.start(wanted.threshold);
  hessian.detect(integral, region, wanted, selection);
  mark(times, VisionStage::Hessian);
  const auto count = static_cast<std::size_t>(wanted.max_features);
  if (wanted.spread) {
    selection.strongest_spread(count, region, out.features);
  } else {
    selection.strongest(count, out.features);
  }
  mark(times, VisionStage::Selection);
  describe_all(out);
  mark(times, VisionStage::Description);
}

/// `part`: the region with its border, which is upsampled.
void FeatureExtractor::Impl::extract_upsampled(const FrameView& frame, const Region& region,
                                               const Region& part, FeatureSet& out) {
  constexpr int k = UpsampledRegion::kFactor;
  FeatureSettings wanted = settings;
  wanted.sigma_min_px *= k;
  wanted.sigma_max_px *= k;
  const FrameView view = upsampled.upsample(frame, part);
  extract(view,
          {k * (region.x_px - part.x_px), k * (region.y_px - part.y_px), k * region.width_px,
           k * region.height_px},
          wanted, out);
  for (Feature& feature : out.features) {
    feature.x_px = upsampled.x_in_frame(feature.x_px);
    feature.y_px = upsampled.y_in_frame(feature.y_px);
    feature.sigma_px /= k;
  }
}

}  // namespace heel
