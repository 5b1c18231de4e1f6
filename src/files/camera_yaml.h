// The values of a camera file, whichever of the spellings they have:
//
// ROS:      camera_matrix: {rows, cols, data}, distortion_model: plumb_bob, distortion_coefficients: {…}
// Message:  K, D, width, height of a CameraInfo message, as `rostopic echo` and `ros2 topic echo` print it
// (k, d)
// RealSense: width, height, fx, fy, ppx, ppy, model, coeffs, in any case, as its tools and the structure
//           rs2_intrinsics name them
// OpenCV:   %YAML:1.0, camera_matrix: !!opencv-matrix {rows, cols, dt, data}, no model name; older files
//           Camera_Matrix, Distortion_Coefficients, image_Width, image_Height; newer code cameraMatrix,
//           distCoeffs
//
// Lists may have commas, spaces or both between their numbers.
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>
#include <vector>

#include "heel/error.h"

namespace heel {

Error camera_key_error(const std::string& path, const std::string& key, const std::string& found,
                       const std::string& expected);

class CameraYaml {
 public:
  /// Throws heel::Error when the file is no YAML map, or has a key twice.
  explicit CameraYaml(const std::string& path);

  const std::string& path() const { return path_; }

  /// The spelling of a key that the file has; the usual one when it has none.
  std::string width_key() const;
  std::string height_key() const;
  std::string matrix_key() const;
  std::string distortion_key() const;

  /// Whether focal lengths and principal point are keys of their own, and there is no matrix.
  bool has_single_values() const;
  /// Then: fx 0 ppx, 0 fy ppy, 0 0 1.
  std::vector<double> matrix_of_single_values() const;
  /// The name of the lens model; empty when the file has none.
  std::string model() const;

  /// A whole number of pixels, 1 to 32768.
  int side_px(const std::string& key) const;
  /// The numbers of a matrix; their count must be rows × cols where the file states those.
  std::vector<double> matrix(const std::string& key, const std::string& expected) const;
  /// Whether the file has the key, or its data, without a value.
  bool is_null(const std::string& key) const;
  /// A word in small letters with _ between its parts; empty when the file does not have the key.
  std::string word(const std::string& key) const;
  /// A whole number; 0 when the file does not have it.
  long count(const std::string& key, const std::string& sub_key = "") const;

 private:
  std::string key_of(const std::vector<std::string>& spellings) const;
  YAML::Node required(const std::string& key, const std::string& expected) const;

  std::string path_;
  YAML::Node root_;
};

}  // namespace heel
