#include "recording/viewer_messages.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

namespace heel {
namespace {

using ViewerJson = nlohmann::ordered_json;

/// "x":…,"y":…,"z":0 and the turn about the vertical axis, as both schemas have them.
void append_pose(std::string& json, const char* place, double x_m, double y_m, const char* turn,
                 double yaw_rad) {
  json += fmt::format("\"{}\":{{\"x\":{},\"y\":{},\"z\":0}},\"{}\":{{\"x\":0,\"y\":0,\"z\":{},\"w\":{}}}",
                      place, x_m, y_m, turn, std::sin(0.5 * yaw_rad), std::cos(0.5 * yaw_rad));
}

std::string timestamp(TimeNs t_ns) {
  return fmt::format("\"timestamp\":{{\"sec\":{},\"nsec\":{}}}", t_ns / kNsPerS, t_ns % kNsPerS);
}

ViewerJson object_of(const std::vector<std::string>& names, const ViewerJson& type) {
  ViewerJson object{{"type", "object"}};
  for (const std::string& name : names) object["properties"][name] = type;
  return object;
}

const ViewerJson kViewerText{{"type", "string"}};

ViewerJson time_type() {
  return object_of({"sec", "nsec"}, {{"type", "integer"}});
}
ViewerJson vector_type(const std::vector<std::string>& names) {
  return object_of(names, {{"type", "number"}});
}

}  // namespace

void append_robot_transform(std::string& json, const TickRecord& tick, TimeNs t_log_ns) {
  const Odometry& odometry = tick.input.robot.odometry;
  if (!tick.input.robot.has_sip) return;
  json += '{' + timestamp(t_log_ns) + ",\"parent_frame_id\":\"odom\",\"child_frame_id\":\"robot\",";
  append_pose(json, "translation", odometry.x_m, odometry.y_m, "rotation", odometry.heading_rad);
  json += '}';
}

void append_person_pose(std::string& json, const TickRecord& tick, TimeNs t_log_ns) {
  if (!tick.target.known) return;
  json += '{' + timestamp(t_log_ns) + ",\"frame_id\":\"robot\",\"pose\":{";
  append_pose(json, "position", tick.target.x_m, tick.target.y_m, "orientation", tick.target.travel_yaw_rad);
  json += "}}";
}

std::string transform_json_schema() {
  return ViewerJson{{"title", "foxglove.FrameTransform"},
                    {"type", "object"},
                    {"properties",
                     {{"timestamp", time_type()},
                      {"parent_frame_id", kViewerText},
                      {"child_frame_id", kViewerText},
                      {"translation", vector_type({"x", "y", "z"})},
                      {"rotation", vector_type({"x", "y", "z", "w"})}}}}
      .dump();
}

std::string pose_in_frame_json_schema() {
  const ViewerJson pose{
      {"type", "object"},
      {"properties",
       {{"position", vector_type({"x", "y", "z"})}, {"orientation", vector_type({"x", "y", "z", "w"})}}}};
  return ViewerJson{{"title", "foxglove.PoseInFrame"},
                    {"type", "object"},
                    {"properties", {{"timestamp", time_type()}, {"frame_id", kViewerText}, {"pose", pose}}}}
      .dump();
}

}  // namespace heel
