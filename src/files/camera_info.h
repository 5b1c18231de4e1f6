// Camera files: intrinsics as ROS camera_info YAML.
#pragma once

#include <string>

#include "heel/camera_model.h"

namespace heel {

/// Reads ROS camera_info YAML, or OpenCV FileStorage (camera_matrix, distortion_coefficients, image_width,
/// image_height). Throws heel::Error naming the file, the key and what was expected.
CameraModel read_camera_model(const std::string& path);

/// Writes ROS camera_info YAML.
void write_camera_model(const CameraModel& camera, const std::string& path);

}  // namespace heel
