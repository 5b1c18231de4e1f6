// The part of the picture in which a flat face can be visible.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/render/ray_table.h"

namespace heel::sim {

/// Distance of the near plane: nothing nearer is drawn.
inline constexpr float kNear_m = 0.05f;

/// Bounds in distorted pixels; empty until something is added.
struct PixelBounds {
  double x_low = 1e9, x_high = -1e9, y_low = 1e9, y_high = -1e9;
  bool empty() const { return x_low > x_high; }
  void add(const Eigen::Vector2d& px);
};

/// Distorted pixel of a point in front of the camera.
Eigen::Vector2d distorted_px(const CameraModel& camera, const Eigen::Vector3f& point_m);

/// Adds the pixels that a polygon (camera frame) can cover. Distortion is only defined inside the picture, so
/// that the polygon is clipped to the pyramid of the picture's rays first.
void add_polygon(const RayTable& rays, std::vector<Eigen::Vector3f> polygon, PixelBounds& bounds);

}  // namespace heel::sim
