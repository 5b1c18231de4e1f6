#include "status_text.h"

#include <fmt/format.h>

#include <string_view>

#include "status_fields.h"

namespace heel::cli {
namespace {

constexpr double kDegPerRad = 57.29577951308232;

/// "p3at-sh, "; empty: the robot has not said what it is.
std::string kind_text(const Json& robot) {
  const auto subclass = robot.find("subclass");
  return subclass == robot.end() || !subclass->is_string() ? "" : subclass->get<std::string>() + ", ";
}

std::string robot_text(const Json& robot) {
  std::string out = fmt::format("{}link {}, motors {}, battery {}", kind_text(robot), text(robot, "link"),
                                flag(robot, "motors") ? "on" : "off", number(robot, "battery_v", "{:.1f} V"));
  out += fmt::format(", speed {}", number(robot, "v_m_s", "{:.2f} m/s"));
  if (flag(robot, "stop_button")) out += ", STOP button pressed";
  if (flag(robot, "bumpers")) out += ", bumper pressed";
  if (flag(robot, "stall")) out += ", wheels stalled";
  return out + fmt::format(", newest packet {} ago", number(robot, "packet_age_s", "{:.2f} s"));
}

std::string camera_text(const Json& camera) {
  std::string out =
      fmt::format("{} frames, {} dropped; the frame in use is {} old", number(camera, "frames", "{:.0f}"),
                  number(camera, "dropped", "{:.0f}"), number(camera, "frame_age_s", "{:.2f} s"));
  const std::string fault = text(camera, "picture");
  if (fault != "none" && fault != "unknown") out += "; the picture: " + fault;
  return out;
}

std::string target_text(const Json& target) {
  std::string out = flag(target, "found")
                        ? fmt::format("in view, certainty {}", number(target, "certainty", "{:.2f}"))
                        : fmt::format("not in view ({})", text(target, "reason"));
  if (flag(target, "known")) out += fmt::format("; {} away", number(target, "distance_m", "{:.2f} m"));
  return out;
}

std::string limits_text(const Json& limits) {
  const auto turn = limits.find("gate.yaw_rate_max_rad_s");
  return fmt::format(
      "speed {}, turn {}, separation {}, clearance {}", number(limits, "gate.v_max_m_s", "{:.2f} m/s"),
      turn == limits.end() || !turn->is_number()
          ? "unknown"
          : fmt::format("{:.0f} °/s", turn->get<double>() * kDegPerRad),
      number(limits, "gate.separation_m", "{:.2f} m"), number(limits, "gate.clearance_m", "{:.2f} m"));
}

}  // namespace

std::string status_text(const Json& status) {
  std::string out = state_line(status);
  out.replace(out.find(": "), 2, "\n");
  out += "\n\n";
  const auto row = [&out](std::string_view name, const std::string& what) {
    out += fmt::format("{:<9}{}\n", name, what);
  };
  row("robot", robot_text(part(status, "robot")));
  row("camera", camera_text(part(status, "camera")));
  row("person", target_text(part(status, "target")));
  row("limits", limits_text(part(status, "limits")));
  if (const auto set = status.find("set"); set != status.end()) {
    for (const Json& change : *set)
      row("set", fmt::format("{} = {} (in the file {}; not saved)", text(change, "key"),
                             text(change, "after"), text(change, "before")));
  }
  return out;
}

std::string watch_text(const Json& status) {
  const Json& robot = part(status, "robot");
  const Json& target = part(status, "target");
  return fmt::format("{} [{}, person {}, {}]", state_line(status), number(robot, "v_m_s", "{:.2f} m/s"),
                     number(target, "distance_m", "{:.2f} m"), number(robot, "battery_v", "{:.1f} V"));
}

}  // namespace heel::cli
