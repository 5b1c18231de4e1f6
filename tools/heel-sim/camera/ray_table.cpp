#include "heel-sim/camera/ray_table.h"

#include <algorithm>
#include <cmath>

#include "heel/error.h"

namespace heel::sim {

RayTable::RayTable(const CameraModel& camera_in) : camera(camera_in) {
  if (camera.width_px < 16 || camera.height_px < 16 || camera.fx <= 0 || camera.fy <= 0)
    throw Error("simulated camera: " + std::to_string(camera.width_px) + " x " +
                std::to_string(camera.height_px) +
                " px (expected at least 16 x 16 and positive focal lengths)");
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

}  // namespace heel::sim
