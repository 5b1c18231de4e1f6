#include "daemon/inputs.h"

#include <cmath>
#include <sstream>

#include "capture/factory/source_address.h"
#include "capture/frame_source.h"
#include "files/camera_info.h"
#include "files/template_file.h"
#include "heel/error.h"

namespace heel {
namespace {

template <typename... Parts>
std::string line_of(const Parts&... parts) {
  std::ostringstream text;
  (text << ... << parts);
  return text.str();
}

/// Pictures read as fast as possible carry the file's own times, which mean nothing beside the robot's.
void check_pace(const CameraConfig& config) {
  if (parse_source_address(config.source).kind != SourceKind::File || config.file_speed > 0.0) return;
  throw Error("camera.file_speed: is 0, but heeld runs in real time and needs more than 0");
}

/// A device delivers the size asked of it; files and the simulator bring their own.
void check_frame_size(const CameraConfig& config, const CameraModel& camera) {
  const SourceKind kind = parse_source_address(config.source).kind;
  if (kind != SourceKind::V4l2 && kind != SourceKind::Libcamera) return;
  if (camera.width_px == config.width_px && camera.height_px == config.height_px) return;
  throw Error(line_of(config.info, ": is for ", camera.width_px, "×", camera.height_px,
                      " pixels, but camera.width_px and camera.height_px ask for ", config.width_px, "×",
                      config.height_px));
}

}  // namespace

void check_against_camera(const Config& config, const CameraModel& camera) {
  const double half_view_rad = std::atan(0.5 * camera.width_px / camera.fx);
  if (config.control.bearing_max_rad < half_view_rad) return;
  throw Error(line_of("control.bearing_max_rad: is ", config.control.bearing_max_rad,
                      ", must be smaller than half the field of view of ", config.camera.info, ", ",
                      half_view_rad, " rad"));
}

Inputs load_inputs(const Config& config) {
  Inputs inputs;
  inputs.camera = read_camera_model(config.camera.info);
  check_pace(config.camera);
  check_frame_size(config.camera, inputs.camera);
  check_against_camera(config, inputs.camera);

  inputs.shirt = read_template(config.target.shirt);
  if (config.target.distance_m > 0.0) inputs.shirt.distance_m = config.target.distance_m;
  if (inputs.shirt.distance_m <= 0.0) {
    throw Error(config.target.shirt + ": does not say at what distance it was taken; set target.distance_m");
  }
  inputs.verdict = judge_template(inputs.shirt);
  if (!inputs.verdict.usable) {
    throw Error(config.target.shirt + ": cannot be followed: " + inputs.verdict.reason);
  }
  return inputs;
}

}  // namespace heel
