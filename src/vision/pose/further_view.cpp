#include "vision/pose/further_view.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "core/frame_view.h"
#include "heel/motion.h"

namespace heel {
namespace {

constexpr int kPlaces = 24;  // of the region, to each side of its middle, from which a search starts
constexpr int kPlaceSteps = 4;
constexpr double kPlaceFound_px = 0.1;
constexpr double kMinFurtherArea =
    0.02;  // picture to reference: features of cloth turned away more are not kept

/// Which place of the reference view each pixel of the further picture shows. Undistorted pixels.
class PlacesShown {
 public:
  PlacesShown(const CameraModel& camera, const BackSurface& surface, const FurtherView& further)
      : surface_(surface),
        K_inverse_(camera.K().inverse()),
        KR_(camera.K() * further.R_further_from_ref),
        Kt_(camera.K() * further.t_over_d) {
    for (int j = -kPlaces; j <= kPlaces; ++j) {
      for (int i = -kPlaces; i <= kPlaces; ++i) {
        const Eigen::Vector3d ray(surface.axis_x + surface.half_size.x() * i / kPlaces,
                                  surface.axis_y + surface.half_size.y() * j / kPlaces, 1.0);
        const Eigen::Vector2d ref_px = (camera.K() * ray).hnormalized();
        if (visible(ref_px)) places_.emplace_back(ref_px, shown_at(ref_px));
      }
    }
  }

  Eigen::Vector2d shown_at(const Eigen::Vector2d& ref_px) const {
    return (KR_ * surface_.point(ray_of(ref_px)) + Kt_).hnormalized();
  }
  /// d picture px / d ref px.
  Eigen::Matrix2d derivative(const Eigen::Vector2d& ref_px) const {
    return image_derivative(surface_, K_inverse_, KR_, Kt_, ray_of(ref_px));
  }
  Eigen::AlignedBox2d visible_box() const {
    Eigen::AlignedBox2d box;
    for (const auto& place : places_) box.extend(place.second);
    return box;
  }
  /// Newton's method from the nearest visible place of a grid.
  std::optional<Eigen::Vector2d> place_at(const Eigen::Vector2d& px) const {
    std::optional<Eigen::Vector2d> ref_px;
    double nearest = std::numeric_limits<double>::infinity();
    for (const auto& [at_ref_px, at_px] : places_) {
      const double distance = (at_px - px).squaredNorm();
      if (distance >= nearest) continue;
      nearest = distance;
      ref_px = at_ref_px;
    }
    for (int i = 0; ref_px && i < kPlaceSteps; ++i) {
      *ref_px += derivative(*ref_px).inverse() * (px - shown_at(*ref_px));
      if (!visible(*ref_px) || !in_region(*ref_px)) return std::nullopt;
    }
    if (!ref_px || !((shown_at(*ref_px) - px).norm() < kPlaceFound_px)) return std::nullopt;
    return ref_px;
  }

 private:
  Eigen::Vector3d ray_of(const Eigen::Vector2d& ref_px) const { return K_inverse_ * ref_px.homogeneous(); }
  bool visible(const Eigen::Vector2d& ref_px) const {
    return (KR_ * surface_.point(ray_of(ref_px)) + Kt_).z() > 0.0 &&
           derivative(ref_px).determinant() > kMinFurtherArea;
  }
  bool in_region(const Eigen::Vector2d& ref_px) const {
    const Eigen::Vector3d ray = ray_of(ref_px);
    return std::abs(surface_.u(ray)) <= 1.0 && std::abs(surface_.v(ray)) <= 1.0;
  }

  const BackSurface& surface_;
  Eigen::Matrix3d K_inverse_, KR_;
  Eigen::Vector3d Kt_;
  std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> places_;  // reference px, picture px
};

/// Of the picture that may show the region. A lens moves its edges by less than the added margin.
Region searched_region(const Eigen::AlignedBox2d& box, const CameraModel& camera) {
  Eigen::AlignedBox2d seen;
  for (const auto corner : {Eigen::AlignedBox2d::TopLeft, Eigen::AlignedBox2d::TopRight,
                            Eigen::AlignedBox2d::BottomLeft, Eigen::AlignedBox2d::BottomRight})
    seen.extend(camera.distort_px(box.corner(corner)));
  constexpr int kMargin_px = 4;
  const int left = static_cast<int>(std::floor(seen.min().x())) - kMargin_px;
  const int top = static_cast<int>(std::floor(seen.min().y())) - kMargin_px;
  return {left, top, static_cast<int>(std::ceil(seen.max().x())) + kMargin_px - left,
          static_cast<int>(std::ceil(seen.max().y())) + kMargin_px - top};
}

FeatureSet features_in(const ShirtTemplate& shirt, const FurtherView& further, const Eigen::AlignedBox2d& box,
                       int max_features) {
  const FrameView picture = packed_frame(further.grey.data(), shirt.camera.width_px, shirt.camera.height_px);
  FeatureSet found;
  FeatureExtractor(shirt.camera.width_px, shirt.camera.height_px,
                   view_feature_settings(shirt, box.sizes(), max_features))
      .extract(picture, searched_region(box, shirt.camera), found);
  return found;
}

}  // namespace

TemplateView further_view(const ShirtTemplate& shirt, const BackSurface& surface, const FurtherView& further,
                          int max_features) {
  const Eigen::Vector3d middle(surface.axis_x, surface.axis_y, 1.0);
  const Eigen::Vector3d middle_now = further.R_further_from_ref * middle + further.t_over_d;
  TemplateView view;
  view.yaw_rad = yaw_of_rotation(further.R_further_from_ref);
  view.scale = 1.0 / middle_now.z();
  const PlacesShown places(shirt.camera, surface, further);
  const Eigen::AlignedBox2d box = places.visible_box();
  if (box.isEmpty()) return view;
  const FeatureSet found = features_in(shirt, further, box, max_features);
  const Eigen::Vector2d centre_px = (shirt.camera.K() * middle_now).hnormalized();
  for (std::size_t i = 0; i < found.features.size(); ++i) {
    const Eigen::Vector2d px = shirt.camera.undistort_px(
        {static_cast<double>(found.features[i].x_px), static_cast<double>(found.features[i].y_px)});
    const std::optional<Eigen::Vector2d> ref_px = places.place_at(px);
    if (!ref_px) continue;
    view.set.features.push_back(found.features[i]);
    view.set.descriptors.push_back(found.descriptors[i]);
    view.ref_px.push_back(*ref_px);
    view.local_scale.push_back(std::sqrt(places.derivative(*ref_px).determinant()));
    view.to_centre_px.push_back(centre_px - px);
  }
  return view;
}

}  // namespace heel
