// The lens as a table: the undistorted ray (x, y, 1) of every pixel, in the camera frame.
#pragma once

#include <vector>

#include "heel/camera_model.h"

namespace heel::sim {

/// The largest |x| and |y| of the rays through the picture's border: a ray outside meets no pixel.
struct RayBounds {
  float x_max = 0.f;
  float y_max = 0.f;
};
RayBounds ray_bounds(const CameraModel& camera);

struct RayTable {
  explicit RayTable(const CameraModel& camera);

  CameraModel camera;
  std::vector<float> x;  ///< row-major, one entry a pixel
  std::vector<float> y;
  /// The largest |x| and |y| of all rays: a ray outside meets no pixel.
  float x_max = 0.f;
  float y_max = 0.f;
};

}  // namespace heel::sim
