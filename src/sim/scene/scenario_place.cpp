// The sections [room], [light], [[obstacle]] and [robot].
#include "sim/scene/scenario_parts.h"

namespace heel::sim {
namespace {

constexpr NumberRange kSize{0.01, 1000, "m"};
constexpr NumberRange kAcceleration{0.05, 10, "m/s²"};
constexpr NumberRange kTrack{0.4, 1.0, "m"};

}  // namespace

void read_robot(TomlSection robot, ScenarioRobot& out) {
  out.model = robot.text("model", out.model);
  out.x_m = robot.number("x_m", out.x_m, kMetres);
  out.y_m = robot.number("y_m", out.y_m, kMetres);
  out.heading_rad = kRadPerDeg * robot.number("heading_deg", 0.0, kTurn_deg);
  out.true_track_m = robot.number("true_track_m", out.true_track_m, kTrack);
  out.left_scale_error = robot.number("left_scale_error", out.left_scale_error, {-0.2, 0.2, ""});
  out.right_scale_error = robot.number("right_scale_error", out.right_scale_error, {-0.2, 0.2, ""});
  out.acceleration_top_m_s2 = robot.number("acceleration_top_m_s2", out.acceleration_top_m_s2, kAcceleration);
  out.brakes_m_s2 = robot.number("brakes_m_s2", out.brakes_m_s2, kAcceleration);
  out.sends_config = robot.boolean("sends_config", out.sends_config);
  for (TomlSection& patch : robot.sections("floor")) {
    FloorPatch floor;
    floor.x_m = patch.required_number("x_m", kMetres);
    floor.y_m = patch.required_number("y_m", kMetres);
    floor.length_m = patch.required_number("length_m", kSize);
    floor.width_m = patch.required_number("width_m", kSize);
    floor.true_track_m = patch.required_number("true_track_m", kTrack);
    patch.reject_unknown_keys();
    out.patches.push_back(floor);
  }
  out.faults = robot.texts("faults");
  robot.reject_unknown_keys();
}

void read_room(TomlSection room, RoomSettings& out) {
  out.margin_m = room.number("margin_m", out.margin_m, {1, 50, "m"});
  out.clearance_m = room.number("clearance_m", out.clearance_m, {0.3, 50, "m"});
  out.objects = static_cast<int>(room.integer("objects", out.objects, 0, 500));
  out.windows = static_cast<int>(room.integer("windows", out.windows, 0, 50));
  out.window_light = room.number("window_light", out.window_light, {0.1, 100, ""});
  out.bump_m = room.number("bump_m", out.bump_m, {0, 0.1, "m"});
  room.reject_unknown_keys();
}

void read_light(TomlSection light, LightSettings& out) {
  out.level = light.number("level", out.level, {0.02, 3, ""});
  out.unevenness = light.number("unevenness", out.unevenness, {0, 0.9, ""});
  out.window_azimuth_rad =
      kRadPerDeg * light.number("window_azimuth_deg", out.window_azimuth_rad / kRadPerDeg, kTurn_deg);
  for (TomlSection& change : light.sections("change")) {
    const LightChange next{change.required_number("at_s", {0, 86400, "s"}),
                           change.required_number("level", {0.01, 10, ""})};
    if (!out.changes.empty() && next.t_s <= out.changes.back().t_s)
      change.fail("at_s", "not after the change before it (expected an order by time)");
    change.reject_unknown_keys();
    out.changes.push_back(next);
  }
  light.reject_unknown_keys();
}

ObstacleSettings read_obstacle(TomlSection obstacle) {
  ObstacleSettings out;
  const std::string kind = obstacle.text("kind", "");
  out.x_m = obstacle.required_number("x_m", kMetres);
  out.y_m = obstacle.required_number("y_m", kMetres);
  if (kind == "pole") {
    out.kind = ObstacleKind::Pole;
    out.height_m = obstacle.number("height_m", 3.0, kSize);
    out.radius_m = obstacle.number("radius_m", out.radius_m, kSize);
    out.length_m = out.width_m = 2.0 * out.radius_m;
  } else if (kind == "box" || kind == "wall" || kind == "doorway") {
    out.kind = kind == "box"    ? ObstacleKind::Box
               : kind == "wall" ? ObstacleKind::Wall
                                : ObstacleKind::Doorway;
    const bool box = out.kind == ObstacleKind::Box;
    out.heading_rad = kRadPerDeg * obstacle.number("heading_deg", 0.0, kTurn_deg);
    out.length_m = obstacle.number("length_m", box ? out.length_m : 3.0, kSize);
    out.width_m = obstacle.number("width_m", box ? out.width_m : 0.12, kSize);
    out.height_m = obstacle.number("height_m", box ? out.height_m : 2.99, kSize);
  } else {
    obstacle.fail("kind", "'" + kind + "' (expected pole, box, wall or doorway)");
  }
  if (out.kind == ObstacleKind::Doorway) {
    out.opening_m = obstacle.number("opening_m", out.opening_m, {0.5, 100, "m"});
    out.lintel_m = obstacle.number("lintel_m", out.lintel_m, {1, 100, "m"});
    if (out.opening_m >= out.length_m)
      obstacle.fail("opening_m", "not narrower than the wall (expected less than length_m)");
    if (out.lintel_m >= out.height_m)
      obstacle.fail("lintel_m", "not lower than the wall (expected less than height_m)");
  }
  obstacle.reject_unknown_keys();
  return out;
}

}  // namespace heel::sim
