#include "vision/pose/template_view.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "vision/pose/further_view.h"
#include "vision/pose/view_geometry.h"
#include "vision/pose/view_renderer.h"

namespace heel {
namespace {

// SURF features are found again up to a turn of 30° and a scaling by √2 or a little more: neighbouring views
// lie twice as far apart. Each view has fewer features than the template: only the strongest are found again.
constexpr double kYaws_rad[] = {-M_PI / 3.0, -M_PI / 6.0, 0.0, M_PI / 6.0, M_PI / 3.0};
constexpr double kScales[] = {1.0, 0.5};
constexpr int kFeaturesPerView = 200;
constexpr std::size_t kMinFeaturesPerView = 8;

}  // namespace

FeatureSettings view_feature_settings(const ShirtTemplate& shirt, const Eigen::Vector2d& size_px,
                                      int max_features) {
  FeatureSettings settings;
  settings.max_features = max_features;
  settings.oriented = shirt.oriented;
  settings.sigma_max_px = static_cast<float>(size_px.minCoeff() / 12.0);
  settings.octaves = settings.sigma_max_px > 6.4f ? 3 : settings.sigma_max_px > 3.2f ? 2 : 1;
  return settings;
}

TemplateView make_view(const ShirtTemplate& shirt, const BackSurface& surface, double yaw_rad, double scale,
                       int max_features) {
  TemplateView view;
  view.yaw_rad = yaw_rad;
  view.scale = scale;
  const ViewGeometry geometry(shirt.camera, surface, yaw_rad, scale);
  const Eigen::AlignedBox2d box = geometry.visible_box();
  if (box.isEmpty()) return view;
  const RenderedView picture = render_view(shirt, geometry, scale);
  FeatureSet found;
  FeatureExtractor(picture.width_px, picture.height_px,
                   view_feature_settings(shirt, box.sizes(), max_features))
      .extract(picture.frame(), found);

  const Eigen::Vector2d centre_px = geometry.project(geometry.ref_px(0.0, 0.0)) - picture.origin_px;
  for (std::size_t i = 0; i < found.features.size(); ++i) {
    const Feature& feature = found.features[i];
    const Eigen::Vector2d px(feature.x_px, feature.y_px);
    const int x = std::clamp(static_cast<int>(std::lround(px.x())), 0, picture.width_px - 1);
    const int y = std::clamp(static_cast<int>(std::lround(px.y())), 0, picture.height_px - 1);
    const std::optional<Eigen::Vector2d>& near_px = picture.ref_px[picture.index(x, y)];
    if (!near_px || !geometry.in_region(*near_px, 1.0)) continue;
    const Eigen::Matrix2d view_from_ref = geometry.derivative(*near_px);
    view.set.features.push_back(feature);
    view.set.descriptors.push_back(found.descriptors[i]);
    view.ref_px.push_back(*near_px + view_from_ref.inverse() * (px - Eigen::Vector2d(x, y)));
    view.local_scale.push_back(std::sqrt(view_from_ref.determinant()));
    view.to_centre_px.push_back(centre_px - px);
  }
  return view;
}

std::vector<TemplateView> make_views(const ShirtTemplate& shirt, const BackSurface& surface) {
  std::vector<TemplateView> views;
  for (const double scale : kScales) {
    for (const double yaw_rad : kYaws_rad) {
      TemplateView view = make_view(shirt, surface, yaw_rad, scale, kFeaturesPerView);
      if (view.set.features.size() >= kMinFeaturesPerView) views.push_back(std::move(view));
    }
  }
  for (const FurtherView& further : shirt.further_views) {
    TemplateView view = further_view(shirt, surface, further, kFeaturesPerView);
    if (view.set.features.size() >= kMinFeaturesPerView) views.push_back(std::move(view));
  }
  return views;
}

const TemplateView& nearest_view(std::span<const TemplateView> views, double yaw_rad, double scale) {
  // Half the size changes a view as much as a turn by 1 rad.
  const auto difference = [&](const TemplateView& view) {
    return std::abs(view.yaw_rad - yaw_rad) + std::abs(std::log2(scale / view.scale));
  };
  return *std::min_element(views.begin(), views.end(), [&](const TemplateView& a, const TemplateView& b) {
    return difference(a) < difference(b);
  });
}

}  // namespace heel
