// The features of a template, and how well it can be followed.
//
// One part of the verdict is a trial: the reference view at half its size is searched and matched as a frame
// is. Since the scaling is known, each match is known to be right or wrong.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "core/frame_view.h"
#include "heel/matching.h"
#include "heel/shirt_template.h"
#include "vision/template/half_size.h"

namespace heel {
namespace {

// A descriptor covers 20 sigma: at this limit 1.7 times the shorter side of the region. A larger one would
// mainly describe the background.
constexpr float kSigmaPerRegionSide = 1.f / 12.f;
constexpr int kMaxOctaves = 4;
constexpr float kLargestSigmaOfFirstOctave_px = 3.2f;  // doubles with every octave

constexpr int kTrialFeatures = 1000;      // as many as a frame has
constexpr double kFarScale = 0.5;         // half_size: a view from twice the distance
constexpr float kSimilarDistance = 0.3f;  // between descriptors

// What a template must have. A detection needs eight inliers (vision.min_inliers).
constexpr int kMinSide_px = 32;
constexpr int kMinFeatures = 24;
constexpr double kMinSpread = 0.4;
constexpr double kMaxSelfSimilarity = 0.5;
constexpr int kMinCoarseFeatures = 12;

FeatureSettings template_settings(const ShirtTemplate& shirt) {
  FeatureSettings settings;
  settings.max_features = shirt.max_features;
  settings.oriented = shirt.oriented;
  settings.sigma_max_px =
      kSigmaPerRegionSide * static_cast<float>(std::min(shirt.roi.width_px, shirt.roi.height_px));
  settings.octaves = 1;
  for (float reached_px = kLargestSigmaOfFirstOctave_px;
       reached_px < settings.sigma_max_px && settings.octaves < kMaxOctaves; reached_px *= 2.f) {
    ++settings.octaves;
  }
  return settings;
}

/// Share of the cells of a 4 × 4 grid over the region that hold a feature.
double spread_of(const FeatureSet& set, const Region& roi) {
  constexpr int kCells = 4;
  std::array<bool, kCells * kCells> holds{};
  const auto cell = [](float at_px, int start_px, int side_px) {
    const int index =
        static_cast<int>((at_px - static_cast<float>(start_px)) * kCells / static_cast<float>(side_px));
    return static_cast<std::size_t>(std::clamp(index, 0, kCells - 1));
  };
  for (const Feature& feature : set.features) {
    holds[cell(feature.y_px, roi.y_px, roi.height_px) * kCells + cell(feature.x_px, roi.x_px, roi.width_px)] =
        true;
  }
  return static_cast<double>(std::count(holds.begin(), holds.end(), true)) / (kCells * kCells);
}

float distance_between(const Descriptor& a, const Descriptor& b) {
  float sum = 0.f;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum);
}

/// Share of the features with a similar feature elsewhere on the shirt. In another view a descriptor changes
/// by 0.2 to 0.4; if another descriptor is as near as that, the ratio test cannot distinguish the two.
double self_similarity_of(const FeatureSet& set) {
  int similar = 0;
  for (std::size_t i = 0; i < set.features.size(); ++i) {
    const Feature& one = set.features[i];
    for (std::size_t j = 0; j < set.features.size(); ++j) {
      const Feature& other = set.features[j];
      const float apart_px = std::hypot(one.x_px - other.x_px, one.y_px - other.y_px);
      if (one.laplacian != other.laplacian || apart_px < 2.f * one.sigma_px) continue;
      if (distance_between(set.descriptors[i], set.descriptors[j]) < kSimilarDistance) {
        ++similar;
        break;
      }
    }
  }
  return static_cast<double>(similar) / static_cast<double>(std::max<std::size_t>(set.features.size(), 1));
}

/// How many of the template's features are correctly matched to those of the view at half its size, as from
/// twice the distance. Only the region is searched, since the background of later frames is unknown.
int correct_matches_at_half_size(const ShirtTemplate& shirt, const FeatureSet& taught) {
  const HalfSizeImage half = half_size(shirt.grey, shirt.camera.width_px, shirt.camera.height_px);
  const Region region{static_cast<int>(shirt.roi.x_px * kFarScale),
                      static_cast<int>(shirt.roi.y_px * kFarScale),
                      static_cast<int>(std::ceil(shirt.roi.width_px * kFarScale)),
                      static_cast<int>(std::ceil(shirt.roi.height_px * kFarScale))};
  FeatureSettings settings = template_settings(shirt);
  settings.max_features = kTrialFeatures;
  FeatureSet seen;
  FeatureExtractor(half.width_px, half.height_px, settings)
      .extract(packed_frame(half.grey.data(), half.width_px, half.height_px), region, seen);

  const auto same = [&](const Feature& ref, const Feature& cur) {
    const double dx_px = (ref.x_px + 0.5) * kFarScale - 0.5 - cur.x_px;
    const double dy_px = (ref.y_px + 0.5) * kFarScale - 0.5 - cur.y_px;
    const double ratio = cur.sigma_px / (ref.sigma_px * kFarScale);
    return std::hypot(dx_px, dy_px) < std::max(1.0, 0.7 * ref.sigma_px * kFarScale) && ratio > 0.6 &&
           ratio < 1.7;
  };
  std::vector<Match> matches;
  Matcher(static_cast<int>(taught.features.size()), kTrialFeatures, MatchSettings{})
      .match(taught, seen, matches);
  return static_cast<int>(std::count_if(matches.begin(), matches.end(), [&](const Match& match) {
    return same(taught.features[static_cast<std::size_t>(match.ref)],
                seen.features[static_cast<std::size_t>(match.cur)]);
  }));
}

[[gnu::format(printf, 1, 2)]] std::string format(const char* pattern, ...) {
  char text[200];
  va_list arguments;
  va_start(arguments, pattern);
  std::vsnprintf(text, sizeof text, pattern, arguments);
  va_end(arguments);
  return text;
}

/// The first reason why the template cannot be followed; empty: it can.
std::string reason_against(const ShirtTemplate& shirt, const TemplateVerdict& verdict) {
  const Region& roi = shirt.roi;
  if (std::min(roi.width_px, roi.height_px) < kMinSide_px) {
    return format(
        "the region is %d x %d px (expected at least %d on each side: come nearer, or use more of the "
        "camera's resolution)",
        roi.width_px, roi.height_px, kMinSide_px);
  }
  if (verdict.features < kMinFeatures) {
    return format(
        "only %d feature%s: the shirt is too plain, or the picture too dark or blurred (expected at "
        "least %d: a print or a coarse pattern)",
        verdict.features, verdict.features == 1 ? "" : "s", kMinFeatures);
  }
  if (verdict.spread < kMinSpread) {
    return format(
        "features in only %.0f %% of the region (expected at least %.0f %%: choose the region round the "
        "print, or a shirt with a larger one)",
        100 * verdict.spread, 100 * kMinSpread);
  }
  if (verdict.self_similarity > kMaxSelfSimilarity) {
    return format(
        "the pattern repeats: %.0f %% of its features are mistaken for one another (expected at most "
        "%.0f %%: no stripes, no check)",
        100 * verdict.self_similarity, 100 * kMaxSelfSimilarity);
  }
  if (verdict.coarse_share * verdict.features < kMinCoarseFeatures) {
    return format(
        "the pattern is too fine: %.0f features are left from twice the distance (expected at least %d: a "
        "larger pattern)",
        verdict.coarse_share * verdict.features, kMinCoarseFeatures);
  }
  return {};
}

}  // namespace

FeatureSet template_features(const ShirtTemplate& shirt) {
  FeatureSet set;
  FeatureExtractor(shirt.camera.width_px, shirt.camera.height_px, template_settings(shirt))
      .extract(packed_frame(shirt.grey.data(), shirt.camera.width_px, shirt.camera.height_px), shirt.roi,
               set);
  return set;
}

TemplateVerdict judge_template(const ShirtTemplate& shirt) {
  const FeatureSet taught = template_features(shirt);
  TemplateVerdict verdict;
  verdict.features = static_cast<int>(taught.features.size());
  if (verdict.features > 0) {
    verdict.spread = spread_of(taught, shirt.roi);
    verdict.self_similarity = self_similarity_of(taught);
    verdict.coarse_share =
        static_cast<double>(correct_matches_at_half_size(shirt, taught)) / verdict.features;
  }
  verdict.reason = reason_against(shirt, verdict);
  verdict.usable = verdict.reason.empty();
  return verdict;
}

}  // namespace heel
