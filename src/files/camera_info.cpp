// The three kinds of camera file, of which ROS camera_info YAML is also written:
//
// ROS:     camera_matrix: {rows, cols, data}, distortion_model: plumb_bob, distortion_coefficients: {…}
// OpenCV:  %YAML:1.0, camera_matrix: !!opencv-matrix {rows, cols, dt, data}, no model name
// Both:    image_width, image_height; coefficients in the order k1 k2 p1 p2 [k3].
#include "files/camera_info.h"

#include <fmt/ranges.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "files/atomic_file.h"
#include "heel/camera_model.h"
#include "heel/error.h"

namespace heel {
namespace {

constexpr std::size_t kMaxCameraInfoBytes = 1 << 20;
constexpr int kMaxSensorSide_px = 32768;
// From a fisheye lens to a long telephoto lens.
constexpr double kMinFocalPerWidth = 0.2;
constexpr double kMaxFocalPerWidth = 10.0;

Error key_error(const std::string& path, const std::string& key, const std::string& found,
                const std::string& expected) {
  return Error(fmt::format("{}: {}: {} (expected {})", path, key, found, expected));
}

/// OpenCV begins its files with "%YAML:1.0", which is not a YAML directive. The line is emptied, not removed,
/// so that line numbers in messages stay right.
std::string without_opencv_directive(std::string text) {
  if (text.starts_with("%YAML:")) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    text.replace(0, end, "");
  }
  return text;
}

YAML::Node parse_file(const std::string& path) {
  const std::string text = read_whole_file(path, kMaxCameraInfoBytes);
  if (text.starts_with("<?xml")) {
    throw Error(path + ": this is XML (expected camera_info YAML, or OpenCV FileStorage in YAML or JSON)");
  }
  YAML::Node root;
  try {
    root = YAML::Load(without_opencv_directive(text));
  } catch (const YAML::Exception& error) {
    throw Error(fmt::format("{}:{}:{}: not YAML: {} (expected a camera_info file)", path, error.mark.line + 1,
                            error.mark.column + 1, error.msg));
  }
  if (!root.IsMap()) {
    throw Error(path +
                ": not a camera file (expected YAML with image_width, image_height, camera_matrix, "
                "distortion_coefficients)");
  }
  return root;
}

YAML::Node required(const YAML::Node& parent, const std::string& path, const std::string& key,
                    const std::string& expected) {
  const YAML::Node node = parent[key];
  if (!node || node.IsNull()) throw key_error(path, key, "missing", expected);
  return node;
}

int read_image_side(const YAML::Node& root, const std::string& path, const std::string& key) {
  const std::string expected = fmt::format("whole number of pixels, 1…{}", kMaxSensorSide_px);
  const YAML::Node node = required(root, path, key, expected);
  int side_px = 0;
  if (!node.IsScalar() || !YAML::convert<int>::decode(node, side_px) || side_px < 1 ||
      side_px > kMaxSensorSide_px) {
    throw key_error(path, key, node.IsScalar() ? "'" + node.Scalar() + "'" : "not a number", expected);
  }
  return side_px;
}

/// The numbers of a matrix; their count must be rows × cols where the file states those.
std::vector<double> read_matrix(const YAML::Node& root, const std::string& path, const std::string& key,
                                const std::string& expected) {
  const YAML::Node matrix = required(root, path, key, expected);
  const YAML::Node data = matrix.IsMap() ? matrix["data"] : matrix;
  if (!data || !data.IsSequence()) throw key_error(path, key + ".data", "missing or not a list", expected);

  std::vector<double> values;
  for (std::size_t i = 0; i < data.size(); ++i) {
    double value = 0.0;
    if (!data[i].IsScalar() || !YAML::convert<double>::decode(data[i], value) || !std::isfinite(value)) {
      throw key_error(path, fmt::format("{}.data[{}]", key, i),
                      data[i].IsScalar() ? "'" + data[i].Scalar() + "'" : "not a number", "a finite number");
    }
    values.push_back(value);
  }
  if (matrix.IsMap() && matrix["rows"] && matrix["cols"]) {
    long rows = 0;
    long cols = 0;
    if (!YAML::convert<long>::decode(matrix["rows"], rows) ||
        !YAML::convert<long>::decode(matrix["cols"], cols) ||
        rows * cols != static_cast<long>(values.size())) {
      throw key_error(path, key, fmt::format("{} numbers", values.size()), "rows × cols of them");
    }
  }
  return values;
}

/// Refuses a focal length or a principal point that no camera with this size of picture has.
void require_possible(const CameraModel& camera, const std::string& path) {
  const std::string key = "camera_matrix.data";
  const double least_px = kMinFocalPerWidth * camera.width_px, most_px = kMaxFocalPerWidth * camera.width_px;
  const auto focal = [&](const char* name, double value_px) {
    if (value_px >= least_px && value_px <= most_px) return;
    throw key_error(path, key, fmt::format("{} {:g}", name, value_px),
                    fmt::format("{:g}…{:g} px; {}", least_px, most_px,
                                value_px < least_px ? "is it in millimetres?" : "was image_width edited?"));
  };
  const auto centre = [&](const char* name, double value_px, int side_px, const char* side) {
    if (value_px >= 0.0 && value_px <= side_px) return;
    throw key_error(path, key, fmt::format("{} {:g}", name, value_px),
                    fmt::format("inside the picture, 0…{} px{}", side_px,
                                value_px > side_px ? fmt::format("; was {} edited?", side) : ""));
  };
  focal("fx", camera.fx);
  focal("fy", camera.fy);
  centre("cx", camera.cx, camera.width_px, "image_width");
  centre("cy", camera.cy, camera.height_px, "image_height");
}

void read_intrinsics(const YAML::Node& root, const std::string& path, CameraModel& camera) {
  const std::string key = "camera_matrix";
  const std::vector<double> k = read_matrix(root, path, key, "3 × 3: fx 0 cx, 0 fy cy, 0 0 1");
  if (k.size() != 9) {
    throw key_error(path, key + ".data", fmt::format("{} numbers", k.size()), "9: fx 0 cx, 0 fy cy, 0 0 1");
  }
  if (k[1] != 0.0) throw key_error(path, key + ".data[1]", fmt::format("skew {}", k[1]), "0: no skew");
  if (k[3] != 0.0 || k[6] != 0.0 || k[7] != 0.0 || k[8] != 1.0) {
    throw key_error(path, key + ".data", "not a pinhole camera's matrix",
                    "fx 0 cx, 0 fy cy, 0 0 1, row by row");
  }
  if (k[0] <= 0.0 || k[4] <= 0.0) {
    throw key_error(path, key + ".data", fmt::format("fx {}, fy {}", k[0], k[4]),
                    "focal lengths above 0, px");
  }
  camera.fx = k[0];
  camera.cx = k[2];
  camera.fy = k[4];
  camera.cy = k[5];
  require_possible(camera, path);
}

/// The lens model of OpenCV that has this number of coefficients.
std::string model_with_coefficients(std::size_t count) {
  switch (count) {
    case 8:
      return "the rational model";
    case 12:
      return "the thin prism model";
    case 14:
      return "the tilted model";
    default:
      return "no known model";
  }
}

void read_distortion(const YAML::Node& root, const std::string& path, CameraModel& camera) {
  if (const YAML::Node model = root["distortion_model"]) {
    const std::string name = model.IsScalar() ? model.Scalar() : "";
    if (name != "plumb_bob") throw key_error(path, "distortion_model", "'" + name + "'", "plumb_bob");
  }
  const std::string key = "distortion_coefficients";
  const std::vector<double> d = read_matrix(root, path, key, "k1 k2 p1 p2 [k3]");
  if (d.size() != 4 && d.size() != 5) {
    throw key_error(path, key + ".data",
                    fmt::format("{} numbers: {}", d.size(), model_with_coefficients(d.size())),
                    "4 or 5, plumb_bob: k1 k2 p1 p2 [k3]");
  }
  camera.k1 = d[0];
  camera.k2 = d[1];
  camera.p1 = d[2];
  camera.p2 = d[3];
  camera.k3 = d.size() == 5 ? d[4] : 0.0;
}

std::string matrix_yaml(const std::string& key, int rows, int cols, const std::vector<double>& values) {
  // 17 digits: reading gives every number back exactly.
  return fmt::format("{}:\n  rows: {}\n  cols: {}\n  data: [{:.17g}]\n", key, rows, cols,
                     fmt::join(values, ", "));
}

}  // namespace

CameraModel read_camera_model(const std::string& path) {
  const YAML::Node root = parse_file(path);
  CameraModel camera;
  camera.width_px = read_image_side(root, path, "image_width");
  camera.height_px = read_image_side(root, path, "image_height");
  read_intrinsics(root, path, camera);
  read_distortion(root, path, camera);
  return camera;
}

void write_camera_model(const CameraModel& camera, const std::string& path) {
  std::string text = fmt::format("image_width: {}\nimage_height: {}\ncamera_name: camera\n", camera.width_px,
                                 camera.height_px);
  text += matrix_yaml("camera_matrix", 3, 3, {camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1});
  text += "distortion_model: plumb_bob\n";
  text +=
      matrix_yaml("distortion_coefficients", 1, 5, {camera.k1, camera.k2, camera.p1, camera.p2, camera.k3});
  text += matrix_yaml("rectification_matrix", 3, 3, {1, 0, 0, 0, 1, 0, 0, 0, 1});
  text += matrix_yaml("projection_matrix", 3, 4,
                      {camera.fx, 0, camera.cx, 0, 0, camera.fy, camera.cy, 0, 0, 0, 1, 0});
  write_file_atomically(path, text);
}

}  // namespace heel
