#include "sim/render/face_window.h"

#include <algorithm>

namespace heel::sim {
namespace {

constexpr int kEdgeSteps = 6;  ///< projected points along each longer edge of the outline

/// Clips a polygon to normal · p + offset ≥ 0.
void clip(std::vector<Eigen::Vector3f>& polygon, const Eigen::Vector3f& normal, float offset) {
  std::vector<Eigen::Vector3f> out;
  out.reserve(polygon.size() + 1);
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector3f& a = polygon[i];
    const Eigen::Vector3f& b = polygon[(i + 1) % polygon.size()];
    const float da = normal.dot(a) + offset;
    const float db = normal.dot(b) + offset;
    if (da >= 0.f) out.push_back(a);
    if ((da >= 0.f) != (db >= 0.f)) out.push_back(a + (b - a) * (da / (da - db)));
  }
  polygon.swap(out);
}

}  // namespace

void PixelBounds::add(const Eigen::Vector2d& px) {
  x_low = std::min(x_low, px.x());
  x_high = std::max(x_high, px.x());
  y_low = std::min(y_low, px.y());
  y_high = std::max(y_high, px.y());
}

Eigen::Vector2d distorted_px(const CameraModel& camera, const Eigen::Vector3f& p) {
  return camera.distort_px({camera.fx * static_cast<double>(p.x() / p.z()) + camera.cx,
                            camera.fy * static_cast<double>(p.y() / p.z()) + camera.cy});
}

void add_polygon(const RayTable& rays, std::vector<Eigen::Vector3f> polygon, PixelBounds& bounds) {
  const float ax = rays.x_max + 0.01f;
  const float ay = rays.y_max + 0.01f;
  clip(polygon, {0, 0, 1}, -kNear_m);
  clip(polygon, {1, 0, ax}, 0.f);
  clip(polygon, {-1, 0, ax}, 0.f);
  clip(polygon, {0, 1, ay}, 0.f);
  clip(polygon, {0, -1, ay}, 0.f);
  if (polygon.size() < 3) return;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector3f& a = polygon[i];
    const Eigen::Vector3f& b = polygon[(i + 1) % polygon.size()];
    const float length_px =
        (a.head<2>() / a.z() - b.head<2>() / b.z()).norm() * static_cast<float>(rays.camera.fx);
    const int steps = length_px > 32.f ? kEdgeSteps : 1;
    for (int k = 0; k < steps; ++k)
      bounds.add(
          distorted_px(rays.camera, a + (b - a) * (static_cast<float>(k) / static_cast<float>(steps))));
  }
}

}  // namespace heel::sim
