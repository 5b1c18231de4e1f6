#include "heel-sim/world/scenario.h"

#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>

#include "heel-sim/world/toml_section.h"
#include "heel/error.h"

namespace heel::sim {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180.0;
constexpr Range kMetres{-1000, 1000, "m"};
constexpr Range kLength{0, 1000, "m"};
constexpr Range kTurnDeg{-720, 720, "deg"};

WalkItem read_walk_item(TomlSection& item) {
  WalkItem out;
  const std::string step = item.text("step", "");
  if (step == "straight") {
    out.step = WalkStep::Straight;
    out.length_m = item.need("length_m", kLength);
  } else if (step == "arc") {
    out.step = WalkStep::Arc;
    out.radius_m = item.need("radius_m", {0.2, 1000, "m"});
    out.angle_rad = kRadPerDeg * item.need("angle_deg", kTurnDeg);
  } else if (step == "to") {
    out.step = WalkStep::To;
    out.x_m = item.need("x_m", kMetres);
    out.y_m = item.need("y_m", kMetres);
    out.radius_m = item.number("radius_m", out.radius_m, {0.2, 1000, "m"});
  } else if (step == "pause") {
    out.step = WalkStep::Pause;
    out.duration_s = item.need("duration_s", {0, 3600, "s"});
  } else if (step == "turn") {
    out.step = WalkStep::Turn;
    out.angle_rad = kRadPerDeg * item.need("angle_deg", kTurnDeg);
    out.duration_s = item.need("duration_s", {0.1, 3600, "s"});
  } else {
    item.refuse("step", "'" + step + "' is not a step (expected straight, arc, to, pause or turn)");
  }
  if (out.step != WalkStep::Pause && out.step != WalkStep::Turn)
    out.speed_m_s = item.number("speed_m_s", out.speed_m_s, {0.05, 3, "m/s"});
  item.finish();
  return out;
}

void read_person(TomlSection person, Scenario& scenario) {
  PersonSettings& p = scenario.person;
  const std::string shirt = person.text("shirt", "bold");
  try {
    p.shirt = shirt_design(shirt);
  } catch (const Error& error) {
    person.refuse("shirt", error.what());
  }
  scenario.person_start.x_m = person.number("x_m", 0.0, kMetres);
  scenario.person_start.y_m = person.number("y_m", 0.0, kMetres);
  scenario.person_start.heading_rad = kRadPerDeg * person.number("heading_deg", 0.0, kTurnDeg);
  p.sway_yaw_rad = kRadPerDeg * person.number("sway_yaw_deg", p.sway_yaw_rad / kRadPerDeg, {0, 30, "deg"});
  p.sway_side_m = person.number("sway_side_m", p.sway_side_m, {0, 0.2, "m"});
  p.sway_roll_rad = kRadPerDeg * person.number("sway_roll_deg", p.sway_roll_rad / kRadPerDeg, {0, 20, "deg"});
  p.bob_m = person.number("bob_m", p.bob_m, {0, 0.1, "m"});
  p.lean_rad = kRadPerDeg * person.number("lean_deg", p.lean_rad / kRadPerDeg, {-20, 30, "deg"});
  p.cloth_ripple_m = person.number("cloth_ripple_m", p.cloth_ripple_m, {0, 0.02, "m"});
  scenario.walk_after_s = person.number("walk_after_s", scenario.walk_after_s, {0, 3600, "s"});
  for (TomlSection& item : person.sections("path")) scenario.path.push_back(read_walk_item(item));
  person.finish();
}

/// A name in a scenario is relative to the scenario's own folder.
std::string beside(const std::string& scenario_path, const std::string& name) {
  const std::filesystem::path path(name);
  return path.is_absolute() ? name : (std::filesystem::path(scenario_path).parent_path() / path).string();
}

CameraModel read_model(TomlSection& camera, const std::string& path) {
  if (camera.has("info")) {
    for (const char* key : {"width_px", "height_px", "focal_px", "centre_px", "distortion"})
      if (camera.has(key)) camera.refuse(key, "given beside camera.info (expected one or the other)");
    return read_camera_model(beside(path, camera.text("info", "")));
  }
  CameraModel model = default_camera_model();
  model.width_px = static_cast<int>(camera.integer("width_px", model.width_px, 16, 4096));
  model.height_px = static_cast<int>(camera.integer("height_px", model.height_px, 16, 4096));
  if (const auto focal = camera.numbers("focal_px", 2); !focal.empty()) {
    model.fx = focal[0];
    model.fy = focal[1];
  }
  if (const auto centre = camera.numbers("centre_px", 2); !centre.empty()) {
    model.cx = centre[0];
    model.cy = centre[1];
  }
  if (const auto d = camera.numbers("distortion", 5); !d.empty()) {
    model.k1 = d[0];
    model.k2 = d[1];
    model.p1 = d[2];
    model.p2 = d[3];
    model.k3 = d[4];
  }
  return model;
}

void read_camera(TomlSection camera, const std::string& path, ScenarioCamera& out) {
  out.source = camera.text("source", out.source);
  if (out.source.starts_with("file:"))
    out.source = "file:" + beside(path, out.source.substr(5));
  else if (out.source != "sim")
    camera.refuse("source", "'" + out.source + "' is not a source (expected sim or file:VIDEO)");
  out.model = read_model(camera, path);
  out.rate_hz = camera.number("rate_hz", out.rate_hz, {1, 240, "Hz"});
  out.mount_x_m = camera.number("mount_x_m", out.mount_x_m, {-2, 2, "m"});
  out.mount_y_m = camera.number("mount_y_m", out.mount_y_m, {-2, 2, "m"});
  out.mount_z_m = camera.number("mount_z_m", out.mount_z_m, {0, 3, "m"});
  out.mount_pitch_rad = kRadPerDeg * camera.number("mount_pitch_deg", 0.0, {-60, 60, "deg"});
  SensorSettings& s = out.sensor;
  s.exposure_ms = camera.number("exposure_ms", s.exposure_ms, {0, 100, "ms"});
  s.gain = camera.number("gain", s.gain, {0.05, 20, ""});
  s.blur_sigma_px = camera.number("blur_sigma_px", s.blur_sigma_px, {0, 2, "px"});
  s.vignetting = camera.number("vignetting", s.vignetting, {0, 0.9, ""});
  s.read_noise_grey = camera.number("read_noise_grey", s.read_noise_grey, {0, 50, "grey levels"});
  s.shot_noise_grey = camera.number("shot_noise_grey", s.shot_noise_grey, {0, 50, "grey levels"});
  camera.finish();
}

void read_robot(TomlSection robot, ScenarioRobot& out) {
  out.x_m = robot.number("x_m", out.x_m, kMetres);
  out.y_m = robot.number("y_m", out.y_m, kMetres);
  out.heading_rad = kRadPerDeg * robot.number("heading_deg", 0.0, kTurnDeg);
  out.true_track_m = robot.number("true_track_m", out.true_track_m, {0.4, 1.0, "m"});
  out.left_scale_error = robot.number("left_scale_error", out.left_scale_error, {-0.2, 0.2, ""});
  out.right_scale_error = robot.number("right_scale_error", out.right_scale_error, {-0.2, 0.2, ""});
  out.faults = robot.texts("faults");
  robot.finish();
}

void read_surroundings(TomlSection room, TomlSection light, Scenario& scenario) {
  scenario.room.margin_m = room.number("margin_m", scenario.room.margin_m, {1, 50, "m"});
  scenario.room.clearance_m = room.number("clearance_m", scenario.room.clearance_m, {0.3, 50, "m"});
  scenario.room.objects = static_cast<int>(room.integer("objects", scenario.room.objects, 0, 500));
  room.finish();
  LightSettings& l = scenario.light;
  l.level = light.number("level", l.level, {0.02, 3, ""});
  l.unevenness = light.number("unevenness", l.unevenness, {0, 0.9, ""});
  l.window_azimuth_rad =
      kRadPerDeg * light.number("window_azimuth_deg", l.window_azimuth_rad / kRadPerDeg, kTurnDeg);
  light.finish();
}

}  // namespace

CameraModel default_camera_model() {
  CameraModel model;
  model.width_px = 640;
  model.height_px = 480;
  model.fx = 554.0;
  model.fy = 554.0;
  model.cx = 322.5;
  model.cy = 236.0;
  model.k1 = -0.18;
  model.k2 = 0.06;
  model.p1 = 0.0008;
  model.p2 = -0.0005;
  return model;
}

Scenario parse_scenario(const std::string& text, const std::string& path) {
  toml::table table;
  try {
    table = toml::parse(text, path);
  } catch (const toml::parse_error& error) {
    const toml::source_position at = error.source().begin;
    throw Error(path + ":" + std::to_string(at.line) + ":" + std::to_string(at.column) + ": " +
                std::string(error.description()) + " (expected TOML)");
  }
  TomlSection root(table, "", path);
  Scenario scenario;
  scenario.name = root.text("name", std::filesystem::path(path).stem().string());
  scenario.seed = static_cast<std::uint64_t>(root.integer("seed", 1, 0, INT64_MAX));
  scenario.duration_s = root.number("duration_s", scenario.duration_s, {0.1, 86400, "s"});
  scenario.vision_latency_ms = root.number("vision_latency_ms", scenario.vision_latency_ms, {0, 1000, "ms"});
  read_person(root.section("person"), scenario);
  read_camera(root.section("camera"), path, scenario.camera);
  read_robot(root.section("robot"), scenario.robot);
  read_surroundings(root.section("room"), root.section("light"), scenario);
  root.finish();
  return scenario;
}

Scenario read_scenario(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw Error(path + ": cannot read (expected a scenario file)");
  std::ostringstream text;
  text << file.rdbuf();
  return parse_scenario(text.str(), path);
}

}  // namespace heel::sim
