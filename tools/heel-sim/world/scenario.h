// A scenario file (TOML): who walks where, in what, in what light, before which camera on which robot.
// tools/heel-sim/scenarios/demo.toml shows every key. Same file, same seed: same run, to the bit.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "heel-sim/camera/sensor.h"
#include "heel-sim/world/light.h"
#include "heel-sim/world/person.h"
#include "heel-sim/world/room.h"
#include "heel-sim/world/walk.h"
#include "heel/camera_model.h"

namespace heel::sim {

struct ScenarioCamera {
  std::string source = "sim";  ///< "sim", or "file:VIDEO": frames come from there and no world is drawn
  CameraModel model;
  double rate_hz = 30.0;
  // The optical centre in the robot frame.
  double mount_x_m = 0.15;
  double mount_y_m = 0.0;
  double mount_z_m = 1.1;
  double mount_pitch_rad = 0.0;  ///< + looks up
  SensorSettings sensor;
};

struct ScenarioRobot {
  double x_m = 0.0;
  double y_m = 0.0;
  double heading_rad = 0.0;
  double true_track_m = 0.62;  ///< what it truly turns with on this floor; the firmware believes 0.588
  double left_scale_error = -0.002;
  double right_scale_error = 0.002;
  std::vector<std::string> faults;  ///< "KIND@START[+DURATION][=AMOUNT]", as for heel-sim --fault
};

struct Scenario {
  std::string name;
  std::uint64_t seed = 1;
  double duration_s = 60.0;
  double walk_after_s = 2.0;        ///< the person sets off this long after the robot's motors came on
  double vision_latency_ms = 25.0;  ///< lock step: from the end of the exposure to the pose
  WalkState person_start;
  std::vector<WalkItem> path;
  PersonSettings person;
  RoomSettings room;
  LightSettings light;
  ScenarioCamera camera;
  ScenarioRobot robot;
};

/// The simulator's camera when a scenario names no other: 640 × 480, 60° across, moderate barrel distortion.
CameraModel default_camera_model();

/// Throws heel::Error: "FILE:LINE:COLUMN: KEY: what was found (what was expected)".
Scenario read_scenario(const std::string& path);
Scenario parse_scenario(const std::string& text, const std::string& path);

}  // namespace heel::sim
