#include "vision/pose/view_predictor.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "vision/features/upsampled_region.h"

namespace heel {
namespace {

// A plane turned by 75° loses half its linear size (√cos 75°): its features and outline shrink by that factor
// in addition to the effect of distance.
constexpr double kTiltShrink = 0.5;
constexpr double kScaleMargin = 1.2;  // the template's distance is measured by hand, a back is not flat
// Margins round an expected view: how far a homography from few pairs is off at the outline, as a share of
// its size; how far features' scales lie from what it predicts; and how much nearer the target may come in a
// second.
constexpr double kViewMargin = 0.1;
constexpr double kViewScaleMargin = 1.3;
constexpr double kApproach_1_s = 1.0;
// A candidate may lie beside its back by a quarter of its longer side, and look smaller than it is.
constexpr double kCandidateMargin = 0.4, kCandidateScaleMargin = 1.43;
constexpr double kBudgetWidth_px = 640.0;
// Larger features are found in the whole frame.
constexpr double kLargestInPart_px = 3.0;
// Below this magnification few of the template's features are as large as the smallest filter.
constexpr double kSmallMagnification = 0.8;
// A candidate whose longer side is larger shows enough features as it is, however small its features are
// beside those of a template that was taught from a large picture.
constexpr double kSmallCandidate_px = 240.0;

}  // namespace

MagnificationRange magnification_range(const ShirtTemplate& shirt, const CameraModel& camera,
                                       const VisionConfig& config) {
  require_camera(camera, "current");
  const double focal_ratio = std::sqrt((camera.fx * camera.fy) / (shirt.camera.fx * shirt.camera.fy));
  // A template of unknown distance was taught somewhere in the same range.
  const double nearest_ref_m = shirt.distance_m > 0.0 ? shirt.distance_m : config.distance_min_m;
  const double farthest_ref_m = shirt.distance_m > 0.0 ? shirt.distance_m : config.distance_max_m;
  return {focal_ratio * nearest_ref_m / config.distance_max_m,
          focal_ratio * farthest_ref_m / config.distance_min_m};
}

int frame_feature_budget(const CameraModel& camera, const VisionConfig& config) {
  const double width = std::max(1.0, static_cast<double>(camera.width_px) / kBudgetWidth_px);
  return static_cast<int>(std::lround(config.max_features * width));
}

FeatureSettings frame_feature_settings(const ShirtTemplate& shirt, const FeatureSet& reference,
                                       const MagnificationRange& range, const VisionConfig& config) {
  FeatureSettings settings;
  settings.octaves = config.octaves;
  settings.max_features = config.max_features;
  settings.oriented = shirt.oriented;
  float smallest_px = reference.features.front().sigma_px, largest_px = smallest_px;
  for (const Feature& feature : reference.features) {
    smallest_px = std::min(smallest_px, feature.sigma_px);
    largest_px = std::max(largest_px, feature.sigma_px);
  }
  settings.sigma_min_px = static_cast<float>(smallest_px * range.min * kTiltShrink);
  settings.sigma_max_px = static_cast<float>(largest_px * range.max * kScaleMargin);
  return settings;
}

ShapeLimits frame_shape_limits(const MagnificationRange& range) {
  ShapeLimits limits;
  limits.scale_min = range.min * kTiltShrink;
  limits.scale_max = range.max * kScaleMargin;
  return limits;
}

ViewPredictor::ViewPredictor(const ReferenceView& reference, const CameraModel& camera,
                             const VisionConfig& config, const FeatureSettings& frame_settings)
    : reference_(reference), camera_(camera), tracking_rate_rad_s_(config.tracking_rate_rad_s) {
  whole_frame_.sigma_min_px = frame_settings.sigma_min_px;
  whole_frame_.sigma_max_px = frame_settings.sigma_max_px;
}

ExpectedView ViewPredictor::near(const Eigen::Matrix3d& H_cur_from_ref, double dt_s) const {
  const Eigen::AlignedBox2d box = outline_box(H_cur_from_ref);
  const double moved_px = tracking_rate_rad_s_ * dt_s * std::max(camera_.fx, camera_.fy);
  return around(H_cur_from_ref, box, kViewMargin * box.sizes() + Eigen::Vector2d::Constant(moved_px),
                kViewScaleMargin * (1.0 + kApproach_1_s * dt_s));
}

ExpectedView ViewPredictor::near_candidate(const Eigen::Matrix3d& H_cur_from_ref) const {
  const Eigen::AlignedBox2d box = outline_box(H_cur_from_ref);
  const double side_px = box.sizes().maxCoeff();
  ExpectedView view = around(H_cur_from_ref, box, Eigen::Vector2d::Constant(kCandidateMargin * side_px),
                             kCandidateScaleMargin);
  view.upsample = view.upsample && side_px < kSmallCandidate_px;
  return view;
}

/// Of the template under H, in the frame.
Eigen::AlignedBox2d ViewPredictor::outline_box(const Eigen::Matrix3d& H_cur_from_ref) const {
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& corner : reference_.outline_px)
    box.extend(camera_.distort_px((H_cur_from_ref * corner.homogeneous()).hnormalized()));
  return box;
}

ExpectedView ViewPredictor::around(const Eigen::Matrix3d& H_cur_from_ref, const Eigen::AlignedBox2d& box,
                                   const Eigen::Vector2d& margin_px, double scale_margin) const {
  ExpectedView view;
  const Eigen::Vector2d first = (box.min() - margin_px).array().floor();
  const Eigen::Vector2d size = (box.sizes() + 2.0 * margin_px).array().ceil();
  view.region = {static_cast<int>(first.x()), static_cast<int>(first.y()), static_cast<int>(size.x()),
                 static_cast<int>(size.y())};

  double smallest_px = std::numeric_limits<double>::infinity(), largest_px = 0.0;
  for (std::size_t i = 0; i < reference_.px.size(); ++i) {
    const double sigma_px =
        reference_.set.features[i].sigma_px * local_scale(H_cur_from_ref, reference_.px[i]);
    smallest_px = std::min(smallest_px, sigma_px);
    largest_px = std::max(largest_px, sigma_px);
  }
  view.sigma_min_px = std::max(whole_frame_.sigma_min_px, smallest_px / scale_margin);
  view.sigma_max_px = std::min(whole_frame_.sigma_max_px, largest_px * scale_margin);
  view.upsample = is_small(H_cur_from_ref);
  return view;
}

ExpectedView ViewPredictor::upsampled_part(int index) const {
  // Row and column, 0…2.
  constexpr std::array<std::array<int, 2>, kParts> kOrder{
      {{1, 1}, {1, 0}, {1, 2}, {0, 1}, {2, 1}, {0, 0}, {0, 2}, {2, 0}, {2, 2}}};
  const auto side_px = [](int frame_px) {
    return frame_px / UpsampledRegion::kFactor - 2 * UpsampledRegion::kBorder_px;
  };
  const auto [row, column] = kOrder[static_cast<std::size_t>(index)];
  const int width_px = side_px(camera_.width_px), height_px = side_px(camera_.height_px);
  ExpectedView view;
  view.region = {column * (camera_.width_px - width_px) / 2, row * (camera_.height_px - height_px) / 2,
                 width_px, height_px};
  view.sigma_min_px = whole_frame_.sigma_min_px;
  view.sigma_max_px =
      std::max(whole_frame_.sigma_min_px, std::min(whole_frame_.sigma_max_px, kLargestInPart_px));
  view.upsample = true;
  return view;
}

bool ViewPredictor::is_small(const Eigen::Matrix3d& H_cur_from_ref) const {
  return local_scale(H_cur_from_ref, reference_.centre_px) < kSmallMagnification;
}

}  // namespace heel
