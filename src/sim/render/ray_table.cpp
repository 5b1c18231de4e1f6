#include "sim/render/ray_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "heel/error.h"

namespace heel::sim {

RayTable::RayTable(const CameraModel& camera_in) : camera(camera_in) {
  if (camera.width_px < 16 || camera.height_px < 16 || camera.fx <= 0 || camera.fy <= 0)
    throw Error(
        fmt::format("simulated camera: {} x {} px (expected at least 16 x 16 and positive focal lengths)",
                    camera.width_px, camera.height_px));
  const std::size_t pixels = static_cast<std::size_t>(camera.width_px) * camera.height_px;
  x.reserve(pixels);
  y.reserve(pixels);
  for (int v = 0; v < camera.height_px; ++v) {
    for (int u = 0; u < camera.width_px; ++u) {
      const Eigen::Vector2d ideal = camera.undistort_px({u, v});
      x.push_back(static_cast<float>((ideal.x() - camera.cx) / camera.fx));
      y.push_back(static_cast<float>((ideal.y() - camera.cy) / camera.fy));
      x_max = std::max(x_max, std::abs(x.back()));
      y_max = std::max(y_max, std::abs(y.back()));
    }
  }
}

RayBounds ray_bounds(const CameraModel& camera) {
  RayBounds bounds;
  const auto widen = [&](int u, int v) {
    const Eigen::Vector2d ideal = camera.undistort_px({u, v});
    bounds.x_max = std::max(bounds.x_max, static_cast<float>(std::abs(ideal.x() - camera.cx) / camera.fx));
    bounds.y_max = std::max(bounds.y_max, static_cast<float>(std::abs(ideal.y() - camera.cy) / camera.fy));
  };
  for (int u = 0; u < camera.width_px; ++u) {
    widen(u, 0);
    widen(u, camera.height_px - 1);
  }
  for (int v = 0; v < camera.height_px; ++v) {
    widen(0, v);
    widen(camera.width_px - 1, v);
  }
  return bounds;
}

}  // namespace heel::sim
