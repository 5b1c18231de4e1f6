// The section [camera]: lens, mount, shutter, sensor and frame timing.
#include <filesystem>
#include <string>

#include "files/camera_info.h"
#include "sim/scene/scenario_parts.h"

namespace heel::sim {
namespace {

/// A relative path in a scenario starts at the scenario's folder.
std::string resolved_path(const std::string& scenario_path, const std::string& name) {
  const std::filesystem::path path(name);
  return path.is_absolute() ? name : (std::filesystem::path(scenario_path).parent_path() / path).string();
}

CameraModel read_model(TomlSection& camera, const std::string& path) {
  if (camera.has("info")) {
    for (const char* key : {"width_px", "height_px", "focal_px", "centre_px", "distortion"})
      if (camera.has(key)) camera.fail(key, "given together with camera.info (expected one of the two)");
    return read_camera_model(resolved_path(path, camera.text("info", "")));
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

void read_sensor(TomlSection& camera, SensorSettings& s) {
  s.exposure_ms = camera.number("exposure_ms", s.exposure_ms, {0, 100, "ms"});
  s.gain = camera.number("gain", s.gain, {0.05, 20, ""});
  s.blur_sigma_px = camera.number("blur_sigma_px", s.blur_sigma_px, {0, 2, "px"});
  s.vignetting = camera.number("vignetting", s.vignetting, {0, 0.9, ""});
  s.glare = camera.number("glare", s.glare, {0, 0.9, ""});
  s.read_noise_grey = camera.number("read_noise_grey", s.read_noise_grey, {0, 50, "grey levels"});
  s.shot_noise_grey = camera.number("shot_noise_grey", s.shot_noise_grey, {0, 50, "grey levels"});
}

void read_exposure(TomlSection exposure, ExposureSettings& e) {
  e.automatic = exposure.boolean("automatic", e.automatic);
  e.longest_ms = exposure.number("longest_ms", e.longest_ms, {0.1, 100, "ms"});
  e.most_gain = exposure.number("most_gain", e.most_gain, {1, 64, ""});
  e.lag_s = exposure.number("lag_s", e.lag_s, {0.01, 10, "s"});
  e.step_stops = exposure.number("step_stops", e.step_stops, {0.05, 4, "stops"});
  exposure.reject_unknown_keys();
}

void read_timing(TomlSection& camera, FrameTimingSettings& t) {
  t.drop_share = camera.number("drop_share", t.drop_share, kShare);
  t.late_share = camera.number("late_share", t.late_share, kShare);
  t.late_ms = camera.number("late_ms", t.late_ms, {0, 1000, "ms"});
  t.jitter_ms = camera.number("jitter_ms", t.jitter_ms, {0, 50, "ms"});
}

}  // namespace

void read_camera(TomlSection camera, const std::string& path, ScenarioCamera& out) {
  out.source = camera.text("source", out.source);
  if (out.source.starts_with("file:"))
    out.source = "file:" + resolved_path(path, out.source.substr(5));
  else if (out.source != "sim")
    camera.fail("source", "'" + out.source + "' (expected sim or file:VIDEO)");
  out.model = read_model(camera, path);
  const auto rotate_deg = static_cast<int>(camera.integer("rotate", 0, 0, 270));
  if (rotate_deg % 90 != 0)
    camera.fail("rotate", std::to_string(rotate_deg) + " (expected 0, 90, 180 or 270)");
  out.turn = picture_turn(rotate_deg, camera.boolean("mirror", false));
  out.rate_hz = camera.number("rate_hz", out.rate_hz, {1, 240, "Hz"});
  out.mount_x_m = camera.number("mount_x_m", out.mount_x_m, {-2, 2, "m"});
  out.mount_y_m = camera.number("mount_y_m", out.mount_y_m, {-2, 2, "m"});
  out.mount_z_m = camera.number("mount_z_m", out.mount_z_m, {0, 3, "m"});
  out.mount_pitch_rad = kRadPerDeg * camera.number("mount_pitch_deg", 0.0, {-60, 60, "deg"});
  out.mount_roll_rad = kRadPerDeg * camera.number("mount_roll_deg", 0.0, {-60, 60, "deg"});
  out.readout_ms = camera.number("readout_ms", out.readout_ms, {0, 100, "ms"});
  out.jpeg_quality = static_cast<int>(camera.integer("jpeg_quality", out.jpeg_quality, 0, 100));
  read_sensor(camera, out.sensor);
  read_exposure(camera.section("exposure"), out.exposure);
  read_timing(camera, out.timing);
  camera.reject_unknown_keys();
}

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

}  // namespace heel::sim
