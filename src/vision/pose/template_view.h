// The template as it looks turned or from farther away: a picture made of the reference view's and of the
// back's shape. Its features are still found where the reference view's no longer are. Each knows its place
// in the reference view, so that a match with any of them is a match with the reference view.
//
// Convention: a positive yaw turns the walking direction to the image's right. Units: pixels.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "heel/features.h"
#include "heel/shirt_template.h"
#include "vision/pose/back_surface.h"

namespace heel {

struct TemplateView {
  double yaw_rad = 0.0;
  double scale = 1.0;                         ///< of the middle, view to reference
  FeatureSet set;                             ///< as in the view
  std::vector<Eigen::Vector2d> ref_px;        ///< of each feature: undistorted place in the reference view
  std::vector<double> local_scale;            ///< of each feature, view to reference
  std::vector<Eigen::Vector2d> to_centre_px;  ///< from each feature to the middle of the back, in the view
};

/// As those of the template, for a region that is `size_px` large in the view.
FeatureSettings view_feature_settings(const ShirtTemplate& shirt, const Eigen::Vector2d& size_px,
                                      int max_features);

/// The view of `surface` turned by `yaw_rad`, at 1 / `scale` times the template's distance, and at most
/// `max_features` of its features, strongest first.
TemplateView make_view(const ShirtTemplate& shirt, const BackSurface& surface, double yaw_rad, double scale,
                       int max_features);

/// The views that a search compares a frame with: turned by up to 60° to either side, at the template's
/// distance and at twice of it; then its further views. Those without enough features are left out.
std::vector<TemplateView> make_views(const ShirtTemplate& shirt, const BackSurface& surface);

/// The view that is most like what a camera sees of a back turned by `yaw_rad`, at `scale`. None may be
/// missing.
const TemplateView& nearest_view(std::span<const TemplateView> views, double yaw_rad, double scale);

}  // namespace heel
