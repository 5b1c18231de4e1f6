// The lens as a table: for every pixel the undistorted ray (x, y, 1) in the camera frame.
#pragma once

#include <vector>

#include "heel/camera_model.h"

namespace heel::sim {

/// The largest |x| and |y| of any ray through the border of the picture: what lies outside is not seen.
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
  /// The largest |x| and |y| of any ray: what lies outside is not seen.
  float x_max = 0.f;
  float y_max = 0.f;
};

}  // namespace heel::sim
