#include "vision/template/reference_view.h"

#include <Eigen/LU>
#include <algorithm>
#include <string>

#include "heel/error.h"

namespace heel {
namespace {

FeatureSet checked_features(const ShirtTemplate& shirt, const VisionConfig& config) {
  require_camera(shirt.camera, "template");
  FeatureSet set = template_features(shirt);
  const std::size_t needed = static_cast<std::size_t>(std::max(4, config.min_inliers));
  if (set.features.size() < needed)
    throw Error("template: " + std::to_string(set.features.size()) +
                " features in its region (expected at least " + std::to_string(needed) +
                ", vision.min_inliers)");
  return set;
}

std::vector<Eigen::Vector2d> undistorted(const CameraModel& camera, const FeatureSet& set) {
  std::vector<Eigen::Vector2d> px;
  for (const Feature& feature : set.features)
    px.push_back(camera.undistort_px({static_cast<double>(feature.x_px), static_cast<double>(feature.y_px)}));
  return px;
}

Outline outline_of(const ShirtTemplate& shirt) {
  const double left = shirt.roi.x_px, right = shirt.roi.x_px + shirt.roi.width_px - 1;
  const double top = shirt.roi.y_px, bottom = shirt.roi.y_px + shirt.roi.height_px - 1;
  return {shirt.camera.undistort_px({left, top}), shirt.camera.undistort_px({right, top}),
          shirt.camera.undistort_px({right, bottom}), shirt.camera.undistort_px({left, bottom})};
}

Eigen::Vector2d centre_of(const ShirtTemplate& shirt) {
  return shirt.camera.undistort_px(
      {shirt.roi.x_px + 0.5 * (shirt.roi.width_px - 1), shirt.roi.y_px + 0.5 * (shirt.roi.height_px - 1)});
}

}  // namespace

void require_camera(const CameraModel& camera, const char* whose) {
  if (camera.width_px <= 0 || camera.height_px <= 0 || !(camera.fx > 0.0) || !(camera.fy > 0.0))
    throw Error(std::string(whose) + " camera: width, height, fx and fy must be positive (got " +
                std::to_string(camera.width_px) + " x " + std::to_string(camera.height_px) + ", fx " +
                std::to_string(camera.fx) + ", fy " + std::to_string(camera.fy) + ")");
}

ReferenceView::ReferenceView(const ShirtTemplate& shirt, const VisionConfig& config)
    : set(checked_features(shirt, config)),
      px(undistorted(shirt.camera, set)),
      outline_px(outline_of(shirt)),
      centre_px(centre_of(shirt)),
      K(shirt.camera.K()),
      K_inverse(K.inverse()),
      distance_m(shirt.distance_m) {}

}  // namespace heel
