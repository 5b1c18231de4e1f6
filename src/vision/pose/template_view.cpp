#include "vision/pose/template_view.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "vision/patches/grey_pyramid.h"
#include "vision/pose/further_view.h"

namespace heel {
namespace {

constexpr int kViewMargin_px = 24;  // round the region: as far as descriptors reach
constexpr double kRenderedPart =
    1.12;                              // of the region's half size: cloth just outside of it is rendered, too
constexpr double kLeftPart = 1.5;      // a search that is as far outside does not come back
constexpr int kOutlineSteps = 8;       // places of the region by which the view's size is found, to each side
constexpr double kMinViewArea = 1e-3;  // view to reference: cloth turned away more is not visible
constexpr int kNewtonSteps = 12;
constexpr double kLongestStep_px = 15.0, kViewSettled_px = 0.02, kViewSolved_px = 0.3;
// Sub-samples of a pixel, more of them across, where a turned view is compressed.
constexpr double kSampleRows_px[] = {-0.25, 0.25}, kSampleColumns_px[] = {-0.375, -0.125, 0.125, 0.375};

/// The camera that sees the view: that of the template, without its distortion.
class ViewGeometry {
 public:
  ViewGeometry(const CameraModel& camera, const BackSurface& surface, double yaw_rad, double scale)
      : surface_(surface), K_(camera.K()), K_inverse_(K_.inverse()) {
    const Eigen::Matrix3d R = Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitY()).toRotationMatrix();
    KR_ = K_ * R;
    Kt_ = K_ * (middle() / scale - R * middle());
  }

  Eigen::Vector3d middle() const { return {surface_.axis_x, surface_.axis_y, 1.0}; }
  Eigen::Vector2d ref_px(double u, double v) const {
    const Eigen::Vector3d ray(surface_.axis_x + u * surface_.half_size.x(),
                              surface_.axis_y + v * surface_.half_size.y(), 1.0);
    return (K_ * ray).hnormalized();
  }
  bool in_region(const Eigen::Vector2d& ref_px, double part) const {
    const Eigen::Vector3d ray = K_inverse_ * ref_px.homogeneous();
    return std::abs(surface_.u(ray)) <= part && std::abs(surface_.v(ray)) <= part;
  }
  Eigen::Vector2d project(const Eigen::Vector2d& ref_px) const {
    return (KR_ * surface_.point(K_inverse_ * ref_px.homogeneous()) + Kt_).hnormalized();
  }
  /// d view px / d ref px.
  Eigen::Matrix2d derivative(const Eigen::Vector2d& ref_px) const {
    return image_derivative(surface_, K_inverse_, KR_, Kt_, K_inverse_ * ref_px.homogeneous());
  }
  /// The visible place of the reference view that `view_px` shows; Newton's method from `start_px`.
  std::optional<Eigen::Vector2d> place_shown(const Eigen::Vector2d& view_px,
                                             const Eigen::Vector2d& start_px) const {
    Eigen::Vector2d ref_px = start_px;
    for (int i = 0; i < kNewtonSteps; ++i) {
      const Eigen::Matrix2d D = derivative(ref_px);
      if (!(D.determinant() > kMinViewArea) || !in_region(ref_px, kLeftPart)) return std::nullopt;
      const Eigen::Vector2d step_px = D.inverse() * (view_px - project(ref_px));
      const double length_px = step_px.norm();
      ref_px += std::min(1.0, kLongestStep_px / std::max(length_px, kViewSettled_px)) * step_px;
      if (length_px < kViewSettled_px) break;
    }
    if (!((project(ref_px) - view_px).norm() < kViewSolved_px) || !in_region(ref_px, kRenderedPart))
      return std::nullopt;
    return ref_px;
  }
  /// Of the visible part of the region, in the view.
  Eigen::AlignedBox2d visible_box() const {
    Eigen::AlignedBox2d box;
    for (int j = -kOutlineSteps; j <= kOutlineSteps; ++j) {
      for (int i = -kOutlineSteps; i <= kOutlineSteps; ++i) {
        const Eigen::Vector2d px =
            ref_px(static_cast<double>(i) / kOutlineSteps, static_cast<double>(j) / kOutlineSteps);
        if (derivative(px).determinant() > 0.0) box.extend(project(px));
      }
    }
    return box;
  }

 private:
  const BackSurface& surface_;
  Eigen::Matrix3d K_, K_inverse_, KR_;
  Eigen::Vector3d Kt_;
};

/// A picture of the view, and which place of the reference view each pixel shows.
struct RenderedView {
  int width_px = 0, height_px = 0;
  Eigen::Vector2d origin_px = Eigen::Vector2d::Zero();  ///< of the picture, in the view
  std::vector<std::uint8_t> grey;
  std::vector<std::optional<Eigen::Vector2d>> ref_px;

  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_px) + static_cast<std::size_t>(x);
  }
  FrameView frame() const {
    FrameView frame;
    frame.header.width_px = static_cast<std::uint32_t>(width_px);
    frame.header.height_px = static_cast<std::uint32_t>(height_px);
    frame.grey = grey.data();
    frame.stride_bytes = frame.header.width_px;
    return frame;
  }
};

/// The mean of the pixel's part of the reference picture.
std::uint8_t rendered_pixel(const ViewGeometry& geometry, const CameraModel& camera,
                            const GreyPyramid& reference, std::size_t level, const Eigen::Vector2d& ref_px) {
  const Eigen::Matrix2d ref_from_view = geometry.derivative(ref_px).inverse();
  float sum = 0.f;
  for (const double dy_px : kSampleRows_px)
    for (const double dx_px : kSampleColumns_px)
      sum += reference.at(camera.distort_px(ref_px + ref_from_view * Eigen::Vector2d(dx_px, dy_px)), level);
  const float mean = sum / static_cast<float>(std::size(kSampleRows_px) * std::size(kSampleColumns_px));
  return static_cast<std::uint8_t>(std::clamp(mean + 0.5f, 0.f, 255.f));
}

/// Beside the back each row has the level of the back's edge, so that the edge makes no feature: the
/// background of later frames is unknown.
void extend_edges(RenderedView& view) {
  for (int y = 0; y < view.height_px; ++y) {
    int first = -1, last = -1;
    for (int x = 0; x < view.width_px; ++x) {
      if (!view.ref_px[view.index(x, y)]) continue;
      if (first < 0) first = x;
      last = x;
    }
    for (int x = 0; first >= 0 && x < view.width_px; ++x)
      if (!view.ref_px[view.index(x, y)])
        view.grey[view.index(x, y)] = view.grey[view.index(x < first ? first : last, y)];
  }
}

RenderedView rendered(const ShirtTemplate& shirt, const ViewGeometry& geometry,
                      const Eigen::AlignedBox2d& box, double scale) {
  const GreyPyramid reference(shirt.grey, shirt.camera.width_px, shirt.camera.height_px);
  const auto level = static_cast<std::size_t>(
      std::clamp(-std::lround(std::log2(scale)), 0L, static_cast<long>(GreyPyramid::kLevels) - 1));
  RenderedView view;
  view.origin_px = box.min().array().floor() - kViewMargin_px;
  view.width_px = static_cast<int>(std::ceil(box.sizes().x())) + 2 * kViewMargin_px;
  view.height_px = static_cast<int>(std::ceil(box.sizes().y())) + 2 * kViewMargin_px;
  view.grey.resize(view.index(0, view.height_px));
  view.ref_px.resize(view.grey.size());
  double sum = 0.0, count = 0.0;
  for (int y = 0; y < view.height_px; ++y) {
    for (int x = 0; x < view.width_px; ++x) {
      const std::size_t i = view.index(x, y);
      Eigen::Vector2d start_px = geometry.ref_px(0.0, 0.0);  // or what a neighbour shows
      if (x > 0 && view.ref_px[i - 1]) {
        start_px = *view.ref_px[i - 1];
      } else if (y > 0 && view.ref_px[view.index(x, y - 1)]) {
        start_px = *view.ref_px[view.index(x, y - 1)];
      }
      view.ref_px[i] = geometry.place_shown(view.origin_px + Eigen::Vector2d(x, y), start_px);
      if (!view.ref_px[i]) continue;
      view.grey[i] = rendered_pixel(geometry, shirt.camera, reference, level, *view.ref_px[i]);
      sum += view.grey[i];
      count += 1.0;
    }
  }
  const auto mean = static_cast<std::uint8_t>(count > 0.0 ? sum / count : 0.0);
  for (std::size_t i = 0; i < view.grey.size(); ++i)
    if (!view.ref_px[i]) view.grey[i] = mean;
  extend_edges(view);
  return view;
}

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
  const RenderedView picture = rendered(shirt, geometry, box, scale);
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
