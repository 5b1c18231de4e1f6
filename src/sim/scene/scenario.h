// A scenario file (TOML): who walks where, in what, in what light, before which camera on which robot.
// tools/heel-sim/scenarios/README.md lists every key. Same file, same seed: same run, to the bit.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "heel/camera_model.h"
#include "sim/render/exposure.h"
#include "sim/render/frame_timing.h"
#include "sim/render/sensor.h"
#include "sim/scene/light.h"
#include "sim/scene/obstacle.h"
#include "sim/scene/person.h"
#include "sim/scene/room.h"
#include "sim/scene/walk.h"

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
  double mount_roll_rad = 0.0;   ///< + lowers the right side: an error of mounting, heel does not know of it
  double readout_ms = 0.0;       ///< rolling shutter: from the first row's exposure to the last's; 0: global
  int jpeg_quality = 0;  ///< 1…100: frames go through JPEG, as a Motion-JPEG camera's do; 0: they do not
  SensorSettings sensor;
  ExposureSettings exposure;
  FrameTimingSettings timing;
};

/// A patch of floor on which the robot turns with another track: slip by surface.
struct FloorPatch {
  double x_m = 0.0;  ///< its middle
  double y_m = 0.0;
  double length_m = 0.0;  ///< along x
  double width_m = 0.0;   ///< along y
  double true_track_m = 0.62;
};

struct ScenarioRobot {
  double x_m = 0.0;
  double y_m = 0.0;
  double heading_rad = 0.0;
  double true_track_m = 0.62;  ///< what it truly turns with on this floor; the firmware believes 0.588
  double left_scale_error = -0.002;
  double right_scale_error = 0.002;
  std::vector<FloorPatch> patches;  ///< the first that holds the robot's centre counts
  std::vector<std::string> faults;  ///< "KIND@START[+DURATION][=AMOUNT]", as for heel-sim --fault
};

/// Where a passer-by's shirt comes from.
enum class ShirtOrigin : std::uint8_t {
  Own,          ///< `person.shirt`, printed for them alone
  Same,         ///< the very shirt the target wears
  SameColours,  ///< the target's design and greys, another print
};

/// Somebody else.
struct PasserbySettings {
  PersonSettings person;
  ShirtOrigin shirt_origin = ShirtOrigin::Own;
  WalkState start;
  std::vector<WalkItem> path;
  double walk_after_s = 0.0;  ///< after the target set off
};

struct Scenario {
  std::string name;
  std::string shows;  ///< one line: what this scenario is hard by
  std::uint64_t seed = 1;
  double duration_s = 60.0;
  double walk_after_s = 2.0;        ///< the person sets off this long after the robot's motors came on
  double vision_latency_ms = 25.0;  ///< lock step: from the end of the exposure to the pose
  WalkState person_start;
  std::vector<WalkItem> path;
  PersonSettings person;
  std::vector<PasserbySettings> passers_by;
  std::vector<ObstacleSettings> obstacles;
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
