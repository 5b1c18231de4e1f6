#include "back_outline.h"

#include <algorithm>
#include <cmath>

#include "files/image_file.h"

namespace heel::cli {
namespace {

// Shares of the person's height, from regions that people have chosen of several bodies.
constexpr double kCentre = 0.65, kWidth = 0.177, kHeight = 0.25;
// The person does not stand exactly in the middle, and not exactly upright.
constexpr double kSidewaysSigma_m = 0.10, kUpSigma_m = 0.04, kStep_m = 0.02;
constexpr int kFeatures = 1500;

FeatureSet strongest_features(const cv::Mat& grey) {
  FeatureSettings settings;
  settings.octaves = 3;
  settings.max_features = kFeatures;
  settings.spread = false;
  FeatureExtractor extractor(grey.cols, grey.rows, settings);
  FeatureSet found;
  extractor.extract(frame_view_of(grey), found);
  return found;
}

int features_in(const FeatureSet& set, const cv::Rect2d& rectangle) {
  return static_cast<int>(std::ranges::count_if(set.features, [&](const Feature& feature) {
    return rectangle.contains({feature.x_px, feature.y_px});
  }));
}

}  // namespace

Region proposed_back(const cv::Mat& grey, const CameraModel& camera, const CameraConfig& mount,
                     const Person& person) {
  const FeatureSet set = strongest_features(grey);
  const double px_per_m = camera.fx / person.distance_m;
  const cv::Size2d size(kWidth * person.height_m * px_per_m, kHeight * person.height_m * px_per_m);
  const double up_rad = std::atan2(kCentre * person.height_m - mount.mount_z_m, person.distance_m);
  const cv::Point2d centre(camera.cx, camera.cy - camera.fy * std::tan(up_rad - mount.mount_pitch_rad));

  cv::Rect2d best;
  double best_score = -1.0;
  const auto squared = [](double value) { return value * value; };
  const int sideways = static_cast<int>(2.0 * kSidewaysSigma_m / kStep_m);
  const int up = static_cast<int>(2.0 * kUpSigma_m / kStep_m);
  for (int x = -sideways; x <= sideways; ++x) {
    for (int y = -up; y <= up; ++y) {
      const cv::Point2d moved = centre + cv::Point2d(x, y) * (kStep_m * px_per_m);
      const cv::Rect2d rectangle(moved.x - 0.5 * size.width, moved.y - 0.5 * size.height, size.width,
                                 size.height);
      const double likely =
          std::exp(-0.5 * squared(x * kStep_m / kSidewaysSigma_m) - 0.5 * squared(y * kStep_m / kUpSigma_m));
      const double score = likely * (1 + features_in(set, rectangle));
      if (score <= best_score) continue;
      best_score = score;
      best = rectangle;
    }
  }
  const cv::Rect2d seen = best & cv::Rect2d(0, 0, grey.cols, grey.rows);
  if (seen.area() < 0.5 * best.area()) return {};
  return {static_cast<int>(seen.x), static_cast<int>(seen.y), static_cast<int>(seen.width),
          static_cast<int>(seen.height)};
}

}  // namespace heel::cli
