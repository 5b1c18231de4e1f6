// The geometry of a view of the template: which place of the reference view a pixel of the view shows, and
// back.
//
// Units: pixels, without lens distortion. Unit depth: the template's distance.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>

#include "heel/camera_model.h"
#include "vision/pose/back_surface.h"

namespace heel {

/// The camera that sees the view: that of the template, without its distortion.
class ViewGeometry {
 public:
  /// The back turned by `yaw_rad`, at 1 / `scale` times the template's distance. `surface` is borrowed.
  ViewGeometry(const CameraModel& camera, const BackSurface& surface, double yaw_rad, double scale);

  /// A place of the region: u and v are -1 to 1 from edge to edge.
  Eigen::Vector2d ref_px(double u, double v) const;
  /// True: within `part` of the region's half size.
  bool in_region(const Eigen::Vector2d& ref_px, double part) const;
  Eigen::Vector2d project(const Eigen::Vector2d& ref_px) const;
  /// d view px / d ref px.
  Eigen::Matrix2d derivative(const Eigen::Vector2d& ref_px) const;
  /// The visible place of the reference view that `view_px` shows; Newton's method from `start_px`.
  std::optional<Eigen::Vector2d> place_shown(const Eigen::Vector2d& view_px,
                                             const Eigen::Vector2d& start_px) const;
  /// Of the visible part of the region, in the view.
  Eigen::AlignedBox2d visible_box() const;

 private:
  Eigen::Vector3d middle() const { return {surface_.axis_x, surface_.axis_y, 1.0}; }

  const BackSurface& surface_;
  Eigen::Matrix3d K_, K_inverse_, KR_;
  Eigen::Vector3d Kt_;
};

}  // namespace heel
