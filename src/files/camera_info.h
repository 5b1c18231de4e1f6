// Camera files: intrinsics as ROS camera_info YAML.
#pragma once

#include <string>

#include "heel/camera_model.h"

namespace heel {

/// Reads ROS camera_info YAML, a CameraInfo message as it is printed, or OpenCV FileStorage
/// (files/camera_yaml.h). Throws heel::Error naming the file, the key and what was expected, also for values
/// that no camera has.
CameraModel read_camera_model(const std::string& path);

/// What a camera can have, but hardly has: found, expected and the likely cause in one line; empty for usual
/// cameras.
std::string unusual_values(const CameraModel& camera);

struct CameraFile {
  CameraModel camera;
  std::string warning;  ///< unusual_values() with file and key; empty without any
};
/// As read_camera_model, for those who tell a person.
CameraFile read_camera_file(const std::string& path);

/// As ROS calls it.
const char* lens_model_name(LensModel lens);

/// Writes ROS camera_info YAML.
void write_camera_model(const CameraModel& camera, const std::string& path);

}  // namespace heel
