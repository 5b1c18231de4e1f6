#include "daemon/inputs.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "capture/factory/source_address.h"
#include "core/angles.h"
#include "core/picture_turn.h"
#include "files/camera_info.h"
#include "files/template_file.h"
#include "heel/error.h"
#include "robot/robot_address.h"
#include "vision/template/turned_template.h"

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

/// The direction of the left or right edge of the picture, the one that is nearer to the optical axis.
double nearer_edge_rad(const CameraModel& camera) {
  const auto off_axis_rad = [&](double x_px) {
    return std::atan(std::abs(camera.undistort_px({x_px, camera.cy}).x() - camera.cx) / camera.fx);
  };
  return std::min(off_axis_rad(-0.5), off_axis_rad(camera.width_px - 0.5));
}

std::string verdict_text(const TemplateVerdict& verdict) {
  return fmt::format(
      "{} features over {:.0f} % of the region, {:.0f} % similar to others, {:.0f} % left at twice the "
      "distance",
      verdict.features, 100.0 * verdict.spread, 100.0 * verdict.self_similarity,
      100.0 * verdict.coarse_share);
}

}  // namespace

void check_against_camera(const Config& config, const CameraModel& camera) {
  const double edge_rad = nearer_edge_rad(camera);
  const auto check = [&](const char* key, double bearing_rad) {
    if (bearing_rad < edge_rad) return;
    throw Error(fmt::format("{}: {} (expected less than {:.6g} rad, where the picture of {} ends)", key,
                            bearing_rad, edge_rad, config.camera.info));
  };
  check("control.bearing_max_rad", config.control.bearing_max_rad);
  if (config.control.law == "trail") check("control.trail_bearing_rad", config.control.trail_bearing_rad);
}

Inputs load_inputs(const Config& config) {
  Inputs inputs;
  const auto [camera, warning] = read_camera_file(config.camera.info);
  if (!warning.empty()) inputs.warnings.push_back(warning);
  parse_robot_address(config.robot.address);  // throws for one that cannot be understood
  check_pace(config.camera);
  check_frame_size(config.camera, camera);
  const PictureTurn turn = picture_turn(config.camera.rotate, config.camera.mirror);
  inputs.camera = turned_camera(camera, turn);
  check_against_camera(config, inputs.camera);

  TurnedTemplates templates = templates_for_turned(read_templates(config.target), camera, turn);
  inputs.shirts = std::move(templates.shirts);
  inputs.taught = std::move(templates.taught);
  for (std::size_t i = 0; i < inputs.shirts.size(); ++i) {
    const std::string& file = template_file(config.target, inputs.taught[i]);
    if (inputs.shirts[i].distance_m <= 0.0) {
      throw Error(file + ": has no distance (expected one" +
                  (inputs.taught[i] == 0 ? ", or target.distance_m)" : ": teach it again with --distance)"));
    }
    inputs.verdicts.push_back(judge_template(inputs.shirts[i]));
    if (!inputs.verdicts.back().usable) {
      throw Error(file + ": cannot be followed: " + inputs.verdicts.back().reason);
    }
  }
  return inputs;
}

std::vector<std::string> template_lines(const Config& config, const Inputs& inputs) {
  std::vector<std::string> lines;
  const std::size_t given = 1 + config.target.more_shirts.size();
  for (std::size_t i = 0; i < given; ++i) {
    const ShirtTemplate& shirt = inputs.shirts[i];
    const auto as_it_is =
        std::find(inputs.taught.begin() + static_cast<std::ptrdiff_t>(given), inputs.taught.end(), i);
    const std::string turned =
        shirt.yaw_rad == 0.0 ? "" : fmt::format(", turned by {:.0f}°", shirt.yaw_rad * kDegPerRad);
    const std::string with_camera =
        as_it_is == inputs.taught.end()
            ? ""
            : fmt::format(
                  "; searched turned with the camera's pictures, and, as template {}, as it is, because "
                  "it does not say whether it is upright: teach it with --rotate, 0 if it is, for a "
                  "quicker search",
                  as_it_is - inputs.taught.begin());
    lines.push_back(fmt::format("{}: taken at {:.2f} m{}; {}{}", template_file(config.target, i),
                                shirt.distance_m, turned, verdict_text(inputs.verdicts[i]), with_camera));
  }
  return lines;
}

ViewFacts view_facts(const Inputs& inputs) {
  ViewFacts facts;
  facts.camera = inputs.camera;
  for (const ShirtTemplate& shirt : inputs.shirts) {
    const Region& roi = shirt.roi;
    const double left_px = roi.x_px, right_px = roi.x_px + roi.width_px;
    const double top_px = roi.y_px, bottom_px = roi.y_px + roi.height_px;
    ShownTemplate shown;
    shown.distance_m = shirt.distance_m;
    shown.corners_px = {Eigen::Vector2d(left_px, top_px), Eigen::Vector2d(right_px, top_px),
                        Eigen::Vector2d(right_px, bottom_px), Eigen::Vector2d(left_px, bottom_px)};
    for (Eigen::Vector2d& corner_px : shown.corners_px) corner_px = shirt.camera.undistort_px(corner_px);
    shown.width_m = shirt.distance_m * (shown.corners_px[1].x() - shown.corners_px[0].x()) / shirt.camera.fx;
    shown.height_m = shirt.distance_m * (shown.corners_px[3].y() - shown.corners_px[0].y()) / shirt.camera.fy;
    facts.templates.push_back(shown);
  }
  return facts;
}

void log_configuration(const LoadedConfig& loaded, const Inputs& inputs) {
  const Config& c = loaded.config;
  spdlog::info("configuration: {}", loaded.file);
  spdlog::info("camera: {}, calibration {}, {}×{} pixels", c.camera.source, c.camera.info,
               inputs.camera.width_px, inputs.camera.height_px);
  for (const std::string& warning : inputs.warnings) spdlog::warn("{}", warning);
  for (const std::string& line : template_lines(c, inputs)) spdlog::info("template: {}", line);
  spdlog::info("robot: {}", c.robot.address);
  if (c.supervisor.start == "at_once")
    spdlog::warn(
        "supervisor.start = \"at_once\": the robot moves without `heel start`; for test benches only");
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
