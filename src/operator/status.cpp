#include "operator/status.h"

#include <fmt/format.h>

#include <cmath>

#include "config/config_table.h"
#include "config/config_value.h"
#include "core/state_sentence.h"
#include "operator/json_number.h"

namespace heel {
namespace {

using json = nlohmann::ordered_json;

json seconds_since(TimeNs t_ns, TimeNs now_ns) {
  return t_ns == 0 ? json(nullptr) : json_number(seconds_from_ns(now_ns - t_ns));
}

json robot_json(const RobotState& robot, TimeNs now_ns) {
  json out = {{"link", to_string(robot.phase)}};
  const bool has_named = robot.kind.choice != ModelChoice::NotYet;
  out["class"] = has_named ? json(robot.kind.robot_class.data()) : json(nullptr);
  out["subclass"] = has_named ? json(robot.kind.subclass.data()) : json(nullptr);
  out["packet_age_s"] = robot.has_sip ? seconds_since(robot.odometry.t_ns, now_ns) : json(nullptr);
  out["motors"] = robot.motors_enabled;
  out["stop_button"] = robot.stop_button;
  out["bumpers"] = robot.bumpers_front != 0 || robot.bumpers_rear != 0;
  out["stall"] = robot.stall_left || robot.stall_right || robot.e_stall;
  out["battery_v"] = json_number(robot.battery_v);
  out["x_m"] = json_number(robot.odometry.x_m);
  out["y_m"] = json_number(robot.odometry.y_m);
  out["heading_rad"] = json_number(robot.odometry.heading_rad);
  out["v_m_s"] = json_number(robot.odometry.v_m_s);
  out["yaw_rate_rad_s"] = json_number(robot.odometry.yaw_rate_rad_s);
  out["reconnects"] = robot.reconnects;
  return out;
}

json camera_json(const StatusInput& input) {
  const ControlInput& tick = input.tick.input;
  json out = {{"frames", input.camera.captured}};
  out["frame_age_s"] = tick.has_pose ? seconds_since(tick.pose.t_capture_ns, input.now_ns) : json(nullptr);
  out["dropped"] = input.camera.dropped_by_driver + input.camera.dropped_unread;
  out["reopened"] = input.camera.reopened;
  out["picture"] = tick.has_pose ? json(to_string(tick.pose.picture)) : json(nullptr);
  return out;
}

json target_json(const TickRecord& tick) {
  const PoseEstimate& pose = tick.input.pose;
  const TargetState& target = tick.target;
  json out = {{"found", tick.input.has_pose && pose.found()}};
  out["reason"] = tick.input.has_pose ? json(to_string(pose.reason)) : json(nullptr);
  out["certainty"] = json_number(pose.certainty);
  out["template"] = pose.template_index;
  out["known"] = target.known;
  if (!target.known) return out;
  out["distance_m"] = json_number(tick.person_m);
  out["x_m"] = json_number(target.x_m);
  out["y_m"] = json_number(target.y_m);
  out["yaw_rad"] = json_number(target.yaw_rad);
  out["travel_yaw_rad"] = json_number(target.travel_yaw_rad);
  return out;
}

json command_json(const TickRecord& tick) {
  return {{"v_m_s", json_number(tick.command.v_m_s)},
          {"yaw_rate_rad_s", json_number(tick.command.yaw_rate_rad_s)},
          {"hold", to_string(tick.hold)},
          {"free_distance_m", json_number(tick.free_distance_m)}};
}

/// The limits in force: every number of the table that has a safer direction.
json limits_json(const Config& config) {
  json out = json::object();
  for (const ConfigKey& key : config_keys()) {
    if (key.tighter == Tighter::None) continue;
    const std::string_view type = type_name(key);
    out[key.full_name()] =
        type == "bool" ? json(number_value(key, config) != 0.0) : json_number(number_value(key, config));
  }
  return out;
}

}  // namespace

std::string sentence_of(const StatusInput& input) {
  if (!input.any_tick) return "the control loop has not run yet";
  constexpr TimeNs kLate_ns = 500 * kNsPerMs;
  const TickRecord& tick = input.tick;
  if (input.now_ns - tick.input.now_ns > kLate_ns) {
    return fmt::format("the control loop has not run for {:.1f} s",
                       seconds_from_ns(input.now_ns - tick.input.now_ns));
  }
  return state_sentence(tick);
}

json state_json(const StatusInput& input) {
  return {{"state", to_string(input.tick.state)}, {"sentence", sentence_of(input)}};
}

json status_json(const StatusInput& input, const SettingsView& settings) {
  const TickRecord& tick = input.tick;
  json out = state_json(input);
  out["reason"] = to_string(tick.stop_reason);
  out["cause"] = to_string(tick.cause);
  out["in_state_s"] = seconds_since(tick.t_transition_ns, input.now_ns);
  out["tick"] = tick.tick;
  out["tick_age_s"] = input.any_tick ? seconds_since(tick.input.now_ns, input.now_ns) : json(nullptr);
  out["robot"] = robot_json(tick.input.robot, input.now_ns);
  out["camera"] = camera_json(input);
  out["target"] = target_json(tick);
  out["command"] = command_json(tick);
  out["limits"] = limits_json(settings.in_use);
  out["set"] = changes_json(changes_between(settings.file, settings.in_use));
  return out;
}

bool differs_to_a_watcher(const TickRecord& a, const TickRecord& b) {
  return a.state != b.state || a.stop_reason != b.stop_reason || a.hold != b.hold ||
         a.input.pose.picture != b.input.pose.picture || a.cause != b.cause ||
         a.input.robot.phase != b.input.robot.phase;
}

json changes_json(const std::vector<ConfigChange>& changes) {
  json out = json::array();
  for (const ConfigChange& change : changes)
    out.push_back({{"key", change.key}, {"before", change.before}, {"after", change.after}});
  return out;
}

}  // namespace heel
