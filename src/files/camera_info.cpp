// What the values of a camera file mean, and whether a camera can have them. Coefficients in OpenCV's order:
// k1 k2 p1 p2 [k3 [k4 k5 k6 [s1 s2 s3 s4 [tx ty]]]]; of a fisheye lens k1 k2 k3 k4.
#include "files/camera_info.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/angles.h"
#include "files/atomic_file.h"
#include "files/camera_yaml.h"
#include "heel/camera_model.h"
#include "heel/error.h"
#include "vision/lens/lens_fold.h"
#include "vision/lens/lens_models.h"

namespace heel {
namespace {

// From a wide-angle lens to a long telephoto lens.
constexpr double kMinFocalPerWidth = 0.2;
constexpr double kMaxFocalPerWidth = 10.0;
// fy / fx: the width of a pixel by its height. Analogue video has 0.91 (NTSC, 720x480) and 1.09 (PAL,
// 720x576); of one field half of that, of half the columns twice that. The lenses of wide-screen films
// squeeze twofold.
constexpr double kMinPixelAspect = 0.44;
constexpr double kMaxPixelAspect = 2.25;
constexpr double kMinUsualAspect = 0.8;
constexpr double kMaxUsualAspect = 1.25;
// The middle part of each side of the picture, in which the principal point is.
constexpr double kMinCentre = 0.1;
constexpr double kMaxCentre = 0.9;
constexpr double kMinUsualCentre = 0.35;
constexpr double kMaxUsualCentre = 0.65;
// The field of view through the principal point, along the side where it is larger. No plane is seen beyond
// 180 degrees, and the vision takes the shirt for a plane.
constexpr double kMinView_deg = 5.0;
constexpr double kMaxView_deg = 175.0;
constexpr double kViewStep_rad = 1e-3;
constexpr std::size_t kFisheyeCoefficients = 4;

constexpr const char* kModels = "plumb_bob, rational_polynomial or equidistant";

bool all_0(std::span<const double> numbers) {
  return std::all_of(numbers.begin(), numbers.end(), [](double number) { return number == 0.0; });
}

/// Refuses a focal length or a principal point that no camera with this size of picture has.
void require_possible(const CameraModel& camera, const std::string& path, const std::string& key) {
  const double least_px = kMinFocalPerWidth * camera.width_px, most_px = kMaxFocalPerWidth * camera.width_px;
  const auto focal = [&](const char* name, double value_px) {
    if (value_px >= least_px && value_px <= most_px) return;
    throw camera_key_error(
        path, key, fmt::format("{} {:g}", name, value_px),
        fmt::format("{:g}…{:g} px; {}", least_px, most_px,
                    value_px < least_px ? "is it in millimetres?" : "was image_width edited?"));
  };
  const auto centre = [&](const char* name, double value_px, int side_px, const char* side) {
    const double least = kMinCentre * side_px, most = kMaxCentre * side_px;
    if (value_px >= least && value_px <= most) return;
    throw camera_key_error(path, key, fmt::format("{} {:g}", name, value_px),
                           fmt::format("near the middle of the picture, {:g}…{:g} px{}", least, most,
                                       value_px > most ? fmt::format("; was {} edited?", side) : ""));
  };
  focal("fx", camera.fx);
  focal("fy", camera.fy);
  if (camera.fy < kMinPixelAspect * camera.fx || camera.fy > kMaxPixelAspect * camera.fx) {
    throw camera_key_error(
        path, key, fmt::format("fy {:g} beside fx {:g}", camera.fy, camera.fx),
        fmt::format("fy {:g}…{:g} px, with square pixels nearly fx; was one of them edited?",
                    kMinPixelAspect * camera.fx, kMaxPixelAspect * camera.fx));
  }
  centre("cx", camera.cx, camera.width_px, "image_width");
  centre("cy", camera.cy, camera.height_px, "image_height");
}

/// Where the numbers of the camera matrix stand.
std::string matrix_data_key(const CameraYaml& file) {
  const std::string key = file.matrix_key();
  const bool bare = key == "K" || key == "k" || file.has_single_values();
  return bare ? key : key + ".data";
}

void read_intrinsics(const CameraYaml& file, CameraModel& camera) {
  const std::string key = file.matrix_key(), data_key = matrix_data_key(file);
  const std::vector<double> k = file.has_single_values() ? file.matrix_of_single_values()
                                                         : file.matrix(key, "3 × 3: fx 0 cx, 0 fy cy, 0 0 1");
  const auto refuse = [&](const std::string& found, const std::string& expected) {
    throw camera_key_error(file.path(), data_key, found, expected);
  };
  if (k.size() != 9) refuse(fmt::format("{} numbers", k.size()), "9: fx 0 cx, 0 fy cy, 0 0 1");
  if (all_0(k))
    refuse("all 0, as a camera says that was never calibrated",
           "focal length and centre, px: calibrate it, e.g. by `heel calibrate`");
  if (k[1] != 0.0)
    throw camera_key_error(file.path(), data_key + "[1]", fmt::format("skew {}", k[1]), "0: no skew");
  if (k[3] != 0.0 || k[6] != 0.0 || k[7] != 0.0 || k[8] != 1.0)
    refuse(k[2] == 0.0 && k[5] == 0.0 && k[6] > 0.0 ? "rows and columns are exchanged, as MATLAB writes it"
                                                    : "not a pinhole camera's matrix",
           "fx 0 cx, 0 fy cy, 0 0 1, row by row");
  if (k[0] <= 0.0 || k[4] <= 0.0)
    refuse(fmt::format("fx {}, fy {}", k[0], k[4]), "focal lengths above 0, px");
  camera.fx = k[0];
  camera.cx = k[2];
  camera.fy = k[4];
  camera.cy = k[5];
  require_possible(camera, file.path(), data_key);
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

/// The models of RealSense cameras that are plumb_bob with some coefficients only: one is applied the other
/// way round, the other differs by what p1 and p2 do.
bool is_same_as_plumb_bob(const std::string& name, const std::vector<double>& d) {
  if (name == "inverse_brown_conrady") return all_0(d);
  return name == "modified_brown_conrady" && (d.size() < 4 || all_0(std::span(d).subspan(2, 2)));
}

/// The model that the file names; of a file that names none, as OpenCV writes it: by the number of
/// coefficients.
LensModel named_model(const CameraYaml& file, const std::vector<double>& d) {
  const std::string name = file.model();
  if (name == "plumb_bob" || name == "radtan" || name == "brown_conrady") return LensModel::PlumbBob;
  if (is_same_as_plumb_bob(name, d)) return LensModel::PlumbBob;
  if (name == "inverse_brown_conrady" || name == "modified_brown_conrady")
    throw camera_key_error(file.path(), "model", "'" + name + "' with coefficients that are not 0",
                           "brown_conrady; calibrate the camera by `heel calibrate`");
  if (name == "rational_polynomial" || name == "rational") return LensModel::Rational;
  if (name == "equidistant" || name == "fisheye" || name == "kannala_brandt4") return LensModel::Fisheye;
  if (!name.empty() && name != "none")
    throw camera_key_error(file.path(), "distortion_model", "'" + name + "'", kModels);
  if (file.count("fisheye_model") != 0) return LensModel::Fisheye;
  return d.size() > 5 ? LensModel::Rational : LensModel::PlumbBob;
}

/// The first `used` of the coefficients. The others must be 0: then the lens is the same without them.
std::vector<double> leading(const CameraYaml& file, const std::vector<double>& d, std::size_t used,
                            const std::string& expected) {
  std::vector<double> first = d;
  first.resize(used, 0.0);
  if (!all_0(std::span(d).subspan(std::min(used, d.size())))) {
    const std::string key = file.distortion_key();
    throw camera_key_error(file.path(), key == "D" || key == "d" ? key : key + ".data",
                           fmt::format("{} numbers: {}", d.size(), model_with_coefficients(d.size())),
                           expected);
  }
  return first;
}

void require_known_count(const CameraYaml& file, std::size_t count) {
  for (const std::size_t known : {0u, 4u, 5u, 8u, 12u, 14u})
    if (count == known) return;
  throw camera_key_error(file.path(), file.distortion_key(), fmt::format("{} numbers", count),
                         "4 or 5: k1 k2 p1 p2 [k3]; 8 of the rational model; 4 of a fisheye lens");
}

void read_distortion(const CameraYaml& file, CameraModel& camera) {
  const std::string key = file.distortion_key();
  std::vector<double> given;  // of a lens without distortion, programs write null
  if (!file.is_null(key)) given = file.matrix(key, "k1 k2 p1 p2 [k3]");
  require_known_count(file, given.size());
  const LensModel model = named_model(file, given);
  if (model == LensModel::Fisheye) {
    const std::vector<double> d = leading(file, given, kFisheyeCoefficients, "4, equidistant: k1 k2 k3 k4");
    camera.lens = model;
    camera.k1 = d[0];
    camera.k2 = d[1];
    camera.k3 = d[2];
    camera.k4 = d[3];
    return;
  }
  const std::vector<double> d =
      model == LensModel::Rational
          ? leading(file, given, 8, "8, rational_polynomial: k1 k2 p1 p2 k3 k4 k5 k6")
          : leading(file, given, 5,
                    "4 or 5, plumb_bob: k1 k2 p1 p2 [k3]; or distortion_model: rational_polynomial");
  camera.k1 = d[0];
  camera.k2 = d[1];
  camera.p1 = d[2];
  camera.p2 = d[3];
  camera.k3 = d[4];
  if (model != LensModel::Rational || (d[5] == 0.0 && d[6] == 0.0 && d[7] == 0.0)) return;
  camera.lens = model;
  camera.k4 = d[5];
  camera.k5 = d[6];
  camera.k6 = d[7];
}

/// How far from the optical axis the camera sees at this pixel. CameraModel gives no direction of more than
/// 89°, so that of a fisheye lens is found here.
double off_axis_rad(const CameraModel& camera, double x_px, double y_px) {
  if (camera.lens != LensModel::Fisheye) {
    const Eigen::Vector2d seen = camera.undistort_px({x_px, y_px});
    return std::atan(std::hypot((seen.x() - camera.cx) / camera.fx, (seen.y() - camera.cy) / camera.fy));
  }
  const double distance = std::hypot((x_px - camera.cx) / camera.fx, (y_px - camera.cy) / camera.fy);
  double theta_rad = 0.0;
  while (theta_rad < std::numbers::pi && fisheye_distance(camera, theta_rad) < distance)
    theta_rad += kViewStep_rad;
  return theta_rad;
}

double field_of_view_deg(const CameraModel& camera) {
  const double right_px = camera.width_px - 0.5, bottom_px = camera.height_px - 0.5;
  const double across = off_axis_rad(camera, -0.5, camera.cy) + off_axis_rad(camera, right_px, camera.cy);
  const double along = off_axis_rad(camera, camera.cx, -0.5) + off_axis_rad(camera, camera.cx, bottom_px);
  return std::max(across, along) * kDegPerRad;
}

const char* order_of_coefficients(LensModel lens) {
  switch (lens) {
    case LensModel::PlumbBob:
      return "k1 k2 p1 p2 k3";
    case LensModel::Rational:
      return "k1 k2 p1 p2 k3 k4 k5 k6";
    case LensModel::Fisheye:
      return "k1 k2 k3 k4";
  }
  return "?";
}

/// The distortion of no lens: two directions are seen at one pixel, or the picture shows more than there is.
void require_lens(const CameraModel& camera, const CameraYaml& file) {
  const std::optional<double> fold_px = fold_in_picture_px(camera);
  if (!fold_px) {
    const double view_deg = field_of_view_deg(camera);
    if (view_deg >= kMinView_deg && view_deg <= kMaxView_deg) return;
    throw camera_key_error(file.path(), file.matrix_key(),
                           fmt::format("a field of view of {:.0f}°", view_deg),
                           fmt::format("{:g}…{:g}°{}", kMinView_deg, kMaxView_deg,
                                       view_deg > kMaxView_deg ? "; cut the pictures to their middle" : ""));
  }
  throw camera_key_error(
      file.path(), file.distortion_key(),
      fmt::format("the picture folds {:.0f} px from the principal point, which no lens does", *fold_px),
      fmt::format("coefficients that hold up to the corners: calibrate with the board in the corners too; is "
                  "the order {}?",
                  order_of_coefficients(camera.lens)));
}

/// A CameraInfo message describes the whole sensor, of which it may give a part, or every second pixel.
void refuse_part_of_sensor(const CameraYaml& file) {
  for (const char* key : {"binning_x", "binning_y"}) {
    if (const long binning = file.count(key); binning > 1)
      throw camera_key_error(file.path(), key, std::to_string(binning),
                             "0 or 1: K of the pictures as they are");
  }
  for (const char* key : {"x_offset", "y_offset"}) {
    if (const long offset = file.count("roi", key); offset != 0)
      throw camera_key_error(file.path(), fmt::format("roi.{}", key), std::to_string(offset),
                             "0: the whole picture");
  }
}

std::string matrix_yaml(const std::string& key, int rows, int cols, const std::vector<double>& values) {
  // 17 digits: reading gives every number back exactly.
  return fmt::format("{}:\n  rows: {}\n  cols: {}\n  data: [{:.17g}]\n", key, rows, cols,
                     fmt::join(values, ", "));
}

}  // namespace

CameraModel read_camera_model(const std::string& path) {
  return read_camera_file(path).camera;
}

std::string unusual_values(const CameraModel& camera) {
  const double aspect = camera.fy / camera.fx;
  if (aspect >= kMinUsualAspect && aspect <= kMaxUsualAspect) {
    const double across = camera.cx / camera.width_px, down = camera.cy / camera.height_px;
    const auto is_usual = [](double share) { return share >= kMinUsualCentre && share <= kMaxUsualCentre; };
    if (is_usual(across) && is_usual(down)) return "";
    return fmt::format(
        "the centre cx {:.6g}, cy {:.6g} is at {:.0f} % of the width and {:.0f} % of the height (expected "
        "{:.0f}…{:.0f} "
        "%; were cx and cy exchanged, or were the pictures cut at one side?)",
        camera.cx, camera.cy, 100.0 * across, 100.0 * down, 100.0 * kMinUsualCentre, 100.0 * kMaxUsualCentre);
  }
  return fmt::format(
      "fy {:.6g} is {:.2f} times fx {:.6g} (expected {:g}…{:g} times, with square pixels 1; were the "
      "pictures "
      "squeezed to {}x{}, or was one of the numbers edited? It is right for one field of analogue video, and "
      "for "
      "half of its columns)",
      camera.fy, aspect, camera.fx, kMinUsualAspect, kMaxUsualAspect, camera.width_px, camera.height_px);
}

CameraFile read_camera_file(const std::string& path) {
  const CameraYaml file(path);
  CameraModel camera;
  camera.width_px = file.side_px(file.width_key());
  camera.height_px = file.side_px(file.height_key());
  refuse_part_of_sensor(file);
  read_intrinsics(file, camera);
  read_distortion(file, camera);
  require_lens(camera, file);
  const std::string unusual = unusual_values(camera);
  return {camera, unusual.empty() ? "" : fmt::format("{}: {}: {}", path, matrix_data_key(file), unusual)};
}

const char* lens_model_name(LensModel lens) {
  switch (lens) {
    case LensModel::PlumbBob:
      return "plumb_bob";
    case LensModel::Rational:
      return "rational_polynomial";
    case LensModel::Fisheye:
      return "equidistant";
  }
  return "?";
}

void write_camera_model(const CameraModel& camera, const std::string& path) {
  std::vector<double> d{camera.k1, camera.k2, camera.p1, camera.p2, camera.k3};
  if (camera.lens == LensModel::Rational) d.insert(d.end(), {camera.k4, camera.k5, camera.k6});
  if (camera.lens == LensModel::Fisheye) d = {camera.k1, camera.k2, camera.k3, camera.k4};
  std::string text = fmt::format("image_width: {}\nimage_height: {}\ncamera_name: camera\n", camera.width_px,
                                 camera.height_px);
  text += matrix_yaml("camera_matrix", 3, 3, {camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1});
  text += fmt::format("distortion_model: {}\n", lens_model_name(camera.lens));
  text += matrix_yaml("distortion_coefficients", 1, static_cast<int>(d.size()), d);
  text += matrix_yaml("rectification_matrix", 3, 3, {1, 0, 0, 0, 1, 0, 0, 0, 1});
  text += matrix_yaml("projection_matrix", 3, 4,
                      {camera.fx, 0, camera.cx, 0, 0, camera.fy, camera.cy, 0, 0, 0, 1, 0});
  write_file_atomically(path, text);
}

}  // namespace heel
