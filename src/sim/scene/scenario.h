// Scenario files (TOML): the walks of all people, their clothes, the room, its light, the camera and the
// robot. tools/heel-sim/scenarios/README.md lists every key. The same file and seed give the same run to the
// bit.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/picture_turn.h"
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
  std::string source = "sim";  ///< "sim", or "file:VIDEO": frames come from a file and there is no world
  CameraModel model;           ///< of upright pictures
  PictureTurn turn;            ///< what makes the pictures that it sends upright
  double rate_hz = 30.0;
  // Place of the optical centre in the robot frame, and the camera's attitude.
  double mount_x_m = 0.15;
  double mount_y_m = 0.0;
  double mount_z_m = 1.1;
  double mount_pitch_rad = 0.0;  ///< positive: the camera looks up
  double mount_roll_rad =
      0.0;  ///< positive: the right side is lower; a mounting error, not in heel's configuration
  double readout_ms =
      0.0;               ///< rolling shutter: from the first row's exposure to the last's; 0: global shutter
  int jpeg_quality = 0;  ///< 1…100: frames are compressed as by a Motion-JPEG camera; 0: they are not
  SensorSettings sensor;
  ExposureSettings exposure;
  FrameTimingSettings timing;
};

/// A rectangle of floor with another slip: there the robot turns with another track.
struct FloorPatch {
  double x_m = 0.0;  ///< its centre
  double y_m = 0.0;
  double length_m = 0.0;  ///< along x
  double width_m = 0.0;   ///< along y
  double true_track_m = 0.62;
};

struct ScenarioRobot {
  std::string model;  ///< subclass, "p3dx-sh"; empty: the simulator's default, a p3at-sh
  double x_m = 0.0;
  double y_m = 0.0;
  double heading_rad = 0.0;
  double true_track_m = 0.62;  ///< track with which a P3-AT turns on this floor; its firmware assumes 0.588
  double left_scale_error = -0.002;
  double right_scale_error = 0.002;
  double acceleration_top_m_s2 = 2.0;  ///< of the controller, in CONFIGpac; it obeys no larger SETA
  double brakes_m_s2 = 6.0;            ///< largest deceleration of the wheels, which no packet reports
  bool sends_config = true;            ///< answers CONFIG
  std::vector<FloorPatch> patches;     ///< the first that contains the robot's centre is used
  std::vector<std::string> faults;     ///< "KIND@START[+DURATION][=AMOUNT]", as for heel-sim --fault
};

/// Which shirt a passer-by wears.
enum class ShirtOrigin : std::uint8_t {
  Own,          ///< design `person.shirt`, with a print of its own
  Same,         ///< the target's shirt
  SameColours,  ///< the target's design and grey levels, with another print
};

/// A person who is not the target.
struct PasserbySettings {
  PersonSettings person;
  ShirtOrigin shirt_origin = ShirtOrigin::Own;
  WalkState start;
  std::vector<WalkItem> path;
  double walk_after_s = 0.0;  ///< start of the walk, after that of the target
};

struct Scenario {
  std::string name;
  std::string shows;  ///< one line: what makes this scenario difficult
  std::uint64_t seed = 1;
  double duration_s = 60.0;
  double walk_after_s = 2.0;    ///< start of the target's walk, after the robot's motors are switched on
  double waits_beyond_m = 0.0;  ///< people stand still while the robot is farther from the target; 0: never
  double vision_latency_ms = 25.0;  ///< in lock step: from the end of the exposure to the pose
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

/// The camera of scenarios that name no other: 640 × 480, 60° wide, moderate barrel distortion.
CameraModel default_camera_model();

/// Throws heel::Error: "FILE:LINE:COLUMN: KEY: what was found (what was expected)".
Scenario read_scenario(const std::string& path);
Scenario parse_scenario(const std::string& text, const std::string& path);

}  // namespace heel::sim
