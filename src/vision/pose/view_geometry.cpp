#include "vision/pose/view_geometry.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace heel {
namespace {

constexpr double kRenderedPart =
    1.12;                              // of the region's half size: cloth just outside of it is rendered, too
constexpr double kLeftPart = 1.5;      // a search that is as far outside does not come back
constexpr int kOutlineSteps = 8;       // places of the region by which the view's size is found, to each side
constexpr double kMinViewArea = 1e-3;  // view to reference: cloth turned away more is not visible
constexpr int kNewtonSteps = 12;
constexpr double kLongestStep_px = 15.0, kViewSettled_px = 0.02, kViewSolved_px = 0.3;

}  // namespace

ViewGeometry::ViewGeometry(const CameraModel& camera, const BackSurface& surface, double yaw_rad,
                           double scale)
    : surface_(surface), K_(camera.K()), K_inverse_(K_.inverse()) {
  const Eigen::Matrix3d R = Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitY()).toRotationMatrix();
  KR_ = K_ * R;
  Kt_ = K_ * (middle() / scale - R * middle());
}

Eigen::Vector2d ViewGeometry::ref_px(double u, double v) const {
  const Eigen::Vector3d ray(surface_.axis_x + u * surface_.half_size.x(),
                            surface_.axis_y + v * surface_.half_size.y(), 1.0);
  return (K_ * ray).hnormalized();
}

bool ViewGeometry::in_region(const Eigen::Vector2d& ref_px, double part) const {
  const Eigen::Vector3d ray = K_inverse_ * ref_px.homogeneous();
  return std::abs(surface_.u(ray)) <= part && std::abs(surface_.v(ray)) <= part;
}

Eigen::Vector2d ViewGeometry::project(const Eigen::Vector2d& ref_px) const {
  return (KR_ * surface_.point(K_inverse_ * ref_px.homogeneous()) + Kt_).hnormalized();
}

Eigen::Matrix2d ViewGeometry::derivative(const Eigen::Vector2d& ref_px) const {
  return image_derivative(surface_, K_inverse_, KR_, Kt_, K_inverse_ * ref_px.homogeneous());
}

std::optional<Eigen::Vector2d> ViewGeometry::place_shown(const Eigen::Vector2d& view_px,
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

Eigen::AlignedBox2d ViewGeometry::visible_box() const {
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

}  // namespace heel
