#include "operator/web/live_messages.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <ctime>
#include <utility>

#include "core/state_sentence.h"

namespace heel {
namespace {

struct LimitName {
  GateLimit bit;
  const char* name;
};
constexpr std::array kLimitNames{LimitName{kGateSpeed, "speed"},
                                 LimitName{kGateAcceleration, "acceleration"},
                                 LimitName{kGateAge, "age"},
                                 LimitName{kGateNotFinite, "not finite"},
                                 LimitName{kGateSeparation, "separation"},
                                 LimitName{kGateObstacle, "obstacle"}};

ViewJson limits_of(const VelocityCommand& command) {
  ViewJson names = ViewJson::array();
  for (const LimitName& limit : kLimitNames)
    if ((command.limited_by & limit.bit) != 0) names.push_back(limit.name);
  return names;
}

ViewJson speeds(const VelocityCommand& command) {
  return {{"v_m_s", json_number(command.v_m_s)}, {"yaw_rate_rad_s", json_number(command.yaw_rate_rad_s)}};
}

ViewJson robot_of(const RobotState& robot) {
  return {{"x_m", json_number(robot.odometry.x_m)},
          {"y_m", json_number(robot.odometry.y_m)},
          {"heading_rad", json_number(robot.odometry.heading_rad)},
          {"v_m_s", json_number(robot.odometry.v_m_s)},
          {"yaw_rate_rad_s", json_number(robot.odometry.yaw_rate_rad_s)},
          {"battery_v", robot.has_sip ? json_number(robot.battery_v) : ViewJson()},
          {"link", to_string(robot.phase)},
          {"motors", robot.motors_enabled},
          {"stop_button", robot.stop_button},
          {"bumpers", robot.bumpers_front != 0 || robot.bumpers_rear != 0},
          {"stall", robot.stall_left || robot.stall_right || robot.e_stall}};
}

ViewJson target_of(const TargetState& target) {
  ViewJson out = {{"known", target.known}};
  if (!target.known) return out;
  out["x_m"] = json_number(target.x_m);
  out["y_m"] = json_number(target.y_m);
  out["yaw_rad"] = json_number(target.yaw_rad);
  out["travel_yaw_rad"] = json_number(target.travel_yaw_rad);
  out["travel_yaw_sigma_rad"] = json_number(target.travel_yaw_sigma_rad);
  out["certainty"] = json_number(target.certainty);
  out["walk_m_s"] = json_number(target.walk_m_s);
  out["body_odom"] = {{"x_m", json_number(target.body_odom_x_m)},
                      {"y_m", json_number(target.body_odom_y_m)},
                      {"sigma_m", json_number(target.body_sigma_m)}};
  return out;
}

/// The newest echoes; a sonar that hears none reports the end of its range.
ViewJson sonar_of(const ControlInput& input, const RobotGeometry& robot) {
  constexpr double kNoEcho_m = 4.99;
  ViewJson echoes = ViewJson::array();
  for (std::size_t i = 0; i < input.robot.sonar.size(); ++i) {
    const SonarEcho& echo = input.robot.sonar[i];
    if (!robot.has_sonar(i) || echo.t_ns == 0 || echo.range_m >= kNoEcho_m) continue;
    const Pose2& place = robot.sonars[i];
    echoes.push_back({{"angle_rad", json_number(place.heading_rad)},
                      {"x_m", json_number(place.x_m + echo.range_m * std::cos(place.heading_rad))},
                      {"y_m", json_number(place.y_m + echo.range_m * std::sin(place.heading_rad))},
                      {"range_m", json_number(echo.range_m)},
                      {"age_s", json_number(seconds_from_ns(input.now_ns - echo.t_ns))}});
  }
  return echoes;
}

/// The corners of the template in the picture; null when one of them is not in front of the camera.
ViewJson quad_of(const PoseEstimate& pose, const ViewFacts& facts) {
  if (!pose.found() || pose.template_index >= facts.templates.size()) return nullptr;
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> H_cur_from_ref(
      pose.H_cur_from_ref.data());
  ViewJson quad = ViewJson::array();
  for (const Eigen::Vector2d& corner_px : facts.templates[pose.template_index].corners_px) {
    const Eigen::Vector3d seen = H_cur_from_ref * corner_px.homogeneous();
    if (seen.z() <= 1e-6) return nullptr;
    const Eigen::Vector2d px = facts.camera.distort_px(seen.hnormalized());
    quad.push_back({json_number(px.x(), 10), json_number(px.y(), 10)});
  }
  return quad;
}

/// In the picture as the camera shows it.
ViewJson inliers_of(const PoseMarks& marks, const ViewFacts& facts) {
  ViewJson places = ViewJson::array();
  for (std::uint32_t i = 0; i < marks.inliers; ++i) {
    const auto& [x_px, y_px] = marks.inlier_px[i];
    const Eigen::Vector2d px = facts.camera.distort_px({double{x_px}, double{y_px}});
    places.push_back({json_number(px.x(), 10), json_number(px.y(), 10)});
  }
  return places;
}

ViewJson milliseconds(TimeNs time_ns) {
  return json_number(static_cast<double>(time_ns) * 1e-6, 100);
}

const char* severity(spdlog::level::level_enum level) {
  if (level >= spdlog::level::err) return "error";
  return level == spdlog::level::warn ? "warning" : "info";
}

}  // namespace

std::string tick_message(const TickRecord& tick, const RobotGeometry& robot, TimeNs wall_minus_monotonic_ns) {
  const ControlInput& input = tick.input;
  ViewJson out = {{"type", "tick"}, {"t_s", json_number(seconds_from_ns(input.now_ns))}};
  out["wall_ms"] = (input.now_ns + wall_minus_monotonic_ns) / kNsPerMs;
  out["state"] = to_string(tick.state);
  out["sentence"] = state_sentence(tick);
  out["reason"] = to_string(tick.stop_reason);
  out["hold"] = to_string(tick.hold);
  out["limited_by"] = limits_of(tick.command);
  out["robot"] = robot_of(input.robot);
  out["target"] = target_of(tick.target);
  out["goal"] = tick.target.known ? ViewJson{{"x_m", json_number(tick.target.goal_x_m)},
                                             {"y_m", json_number(tick.target.goal_y_m)}}
                                  : ViewJson();
  out["wanted"] = speeds(tick.wanted);
  out["command"] = speeds(tick.command);
  out["person_m"] = json_number(tick.person_m);
  out["free_distance_m"] = json_number(tick.free_distance_m);
  out["sonar"] = sonar_of(input, robot);
  out["lateness_us"] = json_number(static_cast<double>(input.lateness_ns) * 1e-3, 10);
  return text_of(out);
}

std::string pose_message(const PoseEstimate& pose, const PoseMarks& marks,
                         std::optional<TimeNs> to_command_ns, const ViewFacts& facts) {
  ViewJson out = {{"type", "pose"}, {"frame", pose.frame_sequence}};
  out["t_s"] = json_number(seconds_from_ns(pose.t_capture_ns));
  out["found"] = pose.found();
  out["reason"] = to_string(pose.reason);
  out["certainty"] = json_number(pose.certainty);
  out["inliers"] = pose.inliers;
  out["template"] = pose.template_index;
  out["yaw_rad"] = json_number(pose.yaw_rad);
  out["yaw_sigma_rad"] = json_number(pose.yaw_sigma_rad);
  out["position_m"] = pose.found() && pose.has_distance
                          ? ViewJson{json_number(pose.position_m[0]), json_number(pose.position_m[1]),
                                     json_number(pose.position_m[2])}
                          : ViewJson();
  out["quad"] = quad_of(pose, facts);
  const bool has_marks = marks.frame_sequence == pose.frame_sequence;
  out["predicted"] = has_marks && marks.has_region ? ViewJson(marks.region_px) : ViewJson();
  out["inlier_px"] = has_marks && pose.found() ? inliers_of(marks, facts) : ViewJson();
  out["latency_ms"] = {{"capture_to_vision", milliseconds(pose.t_done_ns - pose.t_capture_ns)},
                       {"to_command", to_command_ns ? milliseconds(*to_command_ns) : ViewJson()}};
  return text_of(out);
}

ViewJson event_json(const LoggedLine& line, TimeNs wall_minus_monotonic_ns) {
  ViewJson out = {{"t_s", json_number(seconds_from_ns(line.t_wall_ns - wall_minus_monotonic_ns))}};
  out["wall"] = fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z", fmt::gmtime(line.t_wall_ns / kNsPerS),
                            line.t_wall_ns / kNsPerMs % 1000);
  out["severity"] = severity(line.level);
  out["part"] = line.part.empty() ? "heeld" : line.part;
  out["text"] = line.text;
  return out;
}

std::string event_message(const LoggedLine& line, TimeNs wall_minus_monotonic_ns) {
  ViewJson out = {{"type", "event"}};
  out.update(event_json(line, wall_minus_monotonic_ns));
  return text_of(out);
}

std::string picture_message(const FrameHeader& header, const std::string& jpeg, TimeNs now_ns) {
  const std::string head = text_of({{"frame", header.sequence},
                                    {"t_s", json_number(seconds_from_ns(header.t_capture_ns))},
                                    {"width", header.width_px},
                                    {"height", header.height_px},
                                    {"full_width", header.width_px},
                                    {"full_height", header.height_px},
                                    {"age_ms", milliseconds(now_ns - header.t_capture_ns)}});
  std::string message;
  message.reserve(4 + head.size() + jpeg.size());
  for (int byte = 0; byte < 4; ++byte) message += static_cast<char>(head.size() >> (8 * byte) & 255);
  return message.append(head).append(jpeg);
}

}  // namespace heel
