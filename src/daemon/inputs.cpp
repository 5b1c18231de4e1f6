#include "daemon/inputs.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cmath>

#include "capture/factory/source_address.h"
#include "files/camera_info.h"
#include "files/template_file.h"
#include "heel/error.h"

namespace heel {
namespace {

/// With speed 0, frames carry the times of the file, which have no relation to the robot's.
void check_pace(const CameraConfig& config) {
  if (parse_source_address(config.source).kind != SourceKind::File || config.file_speed > 0.0) return;
  throw Error("camera.file_speed: 0 (expected more than 0, because heeld runs in real time)");
}

/// A device delivers the size that is requested; files and the simulator have their own size.
void check_frame_size(const CameraConfig& config, const CameraModel& camera) {
  const SourceKind kind = parse_source_address(config.source).kind;
  if (kind != SourceKind::V4l2 && kind != SourceKind::Libcamera) return;
  if (camera.width_px == config.width_px && camera.height_px == config.height_px) return;
  throw Error(fmt::format("{}: is for {}×{} pixels (expected {}×{}, as camera.width_px and camera.height_px)",
                          config.info, camera.width_px, camera.height_px, config.width_px, config.height_px));
}

}  // namespace

void check_against_camera(const Config& config, const CameraModel& camera) {
  const double half_view_rad = std::atan(0.5 * camera.width_px / camera.fx);
  if (config.control.bearing_max_rad < half_view_rad) return;
  throw Error(
      fmt::format("control.bearing_max_rad: {} (expected less than {:.6g} rad, half the field of view of {})",
                  config.control.bearing_max_rad, half_view_rad, config.camera.info));
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
    throw Error(config.target.shirt + ": has no distance (expected one, or target.distance_m)");
  }
  inputs.verdict = judge_template(inputs.shirt);
  if (!inputs.verdict.usable) {
    throw Error(config.target.shirt + ": cannot be followed: " + inputs.verdict.reason);
  }
  return inputs;
}

std::string verdict_text(const TemplateVerdict& verdict) {
  return fmt::format(
      "{} features over {:.0f} % of the region, {:.0f} % similar to others, {:.0f} % left at twice the "
      "distance",
      verdict.features, 100.0 * verdict.spread, 100.0 * verdict.self_similarity,
      100.0 * verdict.coarse_share);
}

void log_configuration(const LoadedConfig& loaded, const Inputs& inputs) {
  const Config& c = loaded.config;
  spdlog::info("configuration: {}", loaded.file);
  spdlog::info("camera: {}, calibration {}, {}×{} pixels", c.camera.source, c.camera.info,
               inputs.camera.width_px, inputs.camera.height_px);
  spdlog::info("template: {}, taken at {:.2f} m; {}", c.target.shirt, inputs.shirt.distance_m,
               verdict_text(inputs.verdict));
  spdlog::info("robot: {}", c.robot.address);
  spdlog::info(
      "limits: speed {:.2f} m/s, yaw rate {:.2f} rad/s, acceleration {:.2f} m/s², deceleration {:.2f} m/s²",
      c.gate.v_max_m_s, c.gate.yaw_rate_max_rad_s, c.gate.acceleration_m_s2, c.gate.deceleration_m_s2);
  spdlog::info("limits: separation {:.2f} m, {}; reverse {}; a command expires after {:.2f} s",
               c.gate.separation_m,
               c.robot.sonar ? fmt::format("clearance {:.2f} m by sonar", c.gate.clearance_m)
                             : "no clearance, the sonars are off",
               c.control.reverse ? "allowed" : "not allowed", c.gate.command_lifetime_s);
}

}  // namespace heel
