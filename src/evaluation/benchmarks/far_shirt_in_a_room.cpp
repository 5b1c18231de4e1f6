#include <cmath>
#include <cstdint>

#include "evaluation/benchmarks/bench_input.h"
#include "sim/lockstep/lockstep.h"
#include "sim/scene/world.h"

namespace heel::evaluation {
namespace {

constexpr double kTeachDistance_m = 1.5;
constexpr double kDistance_m = 5.8;
constexpr double kWebcamFocal_px = 1360.0;  // of a usual webcam, 70° wide
constexpr int kObjects = 140;
constexpr double kBetweenFrames_s = 10.0;  ///< longer than a tracker keeps what it has seen
constexpr double kSideways_m = 0.4, kTurn_rad = 0.12;

sim::PasserbySettings passerby(double x_m, double y_m, double heading_rad) {
  sim::PasserbySettings settings;
  settings.start.x_m = x_m;
  settings.start.y_m = y_m;
  settings.start.heading_rad = heading_rad;
  return settings;
}

sim::Scenario scenario() {
  sim::Scenario scenario;
  scenario.name = "far shirt in a room";
  scenario.seed = 11;
  scenario.robot.x_m = -kDistance_m;
  scenario.camera.model = camera_of(kFarShirtSize);
  scenario.camera.model.fx = scenario.camera.model.fy = kWebcamFocal_px;
  scenario.person.shirt = sim::ShirtDesign::Mosaic;
  // Nobody walks, but the room leaves walks free: so the camera sees the person.
  scenario.path = {{.step = sim::WalkStep::Back, .length_m = kDistance_m + 0.5}};
  scenario.room.clearance_m = 1.2;
  scenario.room.objects = kObjects;
  scenario.passers_by = {passerby(1.5, 1.6, 0.4), passerby(0.6, -1.9, -0.8)};
  return scenario;
}

}  // namespace

BenchInput far_shirt_in_a_room(int frames) {
  const sim::Scenario far = scenario();
  sim::World world(far);
  BenchInput input;
  input.source = "simulated world, the shirt far away";
  input.shirt = sim::teach_from_world(far, kTeachDistance_m);
  input.camera = far.camera.model;
  std::vector<std::uint8_t> grey;
  for (int i = 0; i < frames; ++i) {
    // From place to place, so that the search never finds what it found before in the same pixels.
    const sim::RobotMotion robot{.x_m = far.robot.x_m,
                                 .y_m = kSideways_m * std::sin(1.7 * i),
                                 .heading_rad = kTurn_rad * std::sin(2.3 * i)};
    const double t_s = kBetweenFrames_s * i;
    world.render(robot, t_s, static_cast<std::uint64_t>(i), grey);
    input.frames.push_back({cv::Mat(kFarShirtSize, CV_8U, grey.data()).clone(), ns_from_seconds(t_s)});
  }
  return input;
}

}  // namespace heel::evaluation
