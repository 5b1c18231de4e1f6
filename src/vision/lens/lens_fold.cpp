#include "vision/lens/lens_fold.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "vision/lens/lens_models.h"

namespace heel {
namespace {

constexpr int kDirections = 64;
constexpr double kStep_px = 1.0;
constexpr int kMaxWalkSteps = 20000;
constexpr double kMaxFisheyeTheta_rad = std::numbers::pi;

bool in_picture(const CameraModel& camera, const Eigen::Vector2d& px) {
  return px.x() >= -0.5 && px.y() >= -0.5 && px.x() <= camera.width_px - 0.5 &&
         px.y() <= camera.height_px - 0.5;
}

double farthest_corner_px(const CameraModel& camera) {
  return std::hypot(std::max(camera.cx, camera.width_px - camera.cx),
                    std::max(camera.cy, camera.height_px - camera.cy));
}

/// Of the fisheye model: the distance depends on the angle to the optical axis alone.
std::optional<double> fisheye_fold_px(const CameraModel& camera) {
  const double focal_px = std::max(camera.fx, camera.fy), reach_px = farthest_corner_px(camera);
  for (std::int64_t i = 0;; ++i) {
    const double theta = static_cast<double>(i) * kStep_px / focal_px;
    if (theta > kMaxFisheyeTheta_rad) return std::nullopt;
    const double distance_px = focal_px * fisheye_distance(camera, theta);
    if (distance_px > reach_px) return std::nullopt;
    if (fisheye_slope(camera, theta) <= 0.0) return distance_px;
  }
}

}  // namespace

// Walks from the principal point outwards in all directions, until the seen place leaves the picture. The
// mapping folds where the determinant of its derivative changes its sign.
std::optional<double> fold_in_picture_px(const CameraModel& camera) {
  if (camera.lens == LensModel::Fisheye) return fisheye_fold_px(camera);
  if (!camera.distorted()) return std::nullopt;
  const double focal_px = std::max(camera.fx, camera.fy);
  const Eigen::Vector2d centre_px(camera.cx, camera.cy);
  std::optional<double> nearest_px;
  for (int i = 0; i < kDirections; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kDirections;
    const Eigen::Vector2d along(std::cos(angle) * camera.fx / focal_px,
                                std::sin(angle) * camera.fy / focal_px);
    const Eigen::Vector2d across(-along.y(), along.x());
    for (int step = 1; step < kMaxWalkSteps; ++step) {
      const Eigen::Vector2d undistorted = centre_px + along * (step * kStep_px);
      const Eigen::Vector2d seen = camera.distort_px(undistorted);
      if (!seen.allFinite() || !in_picture(camera, seen)) break;
      Eigen::Matrix2d J;
      J << camera.distort_px(undistorted + along) - seen, camera.distort_px(undistorted + across) - seen;
      if (J.determinant() > 0.0) continue;
      const double fold_px = (seen - centre_px).norm();
      nearest_px = std::min(nearest_px.value_or(fold_px), fold_px);
      break;
    }
  }
  return nearest_px;
}

}  // namespace heel
