#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "core/angles.h"
#include "evaluation/benchmarks/bench_input.h"
#include "sim/lockstep/lockstep.h"
#include "sim/scene/world.h"

namespace heel::evaluation {
namespace {

constexpr double kTeachDistance_m = 1.5;
constexpr double kWalkSpeedM_S = 0.6;
constexpr double kCircleRadius_m = 3.0;
constexpr double kFirstFrame_s = 2.5;  ///< person and robot are under way
constexpr double kStartGap_m = 1.8;

/// Drives at the person and stays behind them: plain, so that a change of heel's control leaves the pictures
/// as they are.
class Follower {
 public:
  const sim::RobotMotion& motion() const { return motion_; }

  void step(const sim::WalkState& person, double dt_s) {
    const double dx = person.x_m - motion_.x_m, dy = person.y_m - motion_.y_m;
    const double bearing = wrap_angle_rad(std::atan2(dy, dx) - motion_.heading_rad);
    motion_.yaw_rate_rad_s = kTurnGain1_S * bearing;
    motion_.v_m_s = std::max(0.0, kDriveGain1_S * (std::hypot(dx, dy) - kStandGap_m));
    motion_.heading_rad += dt_s * motion_.yaw_rate_rad_s;
    motion_.x_m += dt_s * motion_.v_m_s * std::cos(motion_.heading_rad);
    motion_.y_m += dt_s * motion_.v_m_s * std::sin(motion_.heading_rad);
  }

 private:
  static constexpr double kTurnGain1_S = 2.0, kDriveGain1_S = 1.5, kStandGap_m = 1.5;
  sim::RobotMotion motion_{.x_m = -kStartGap_m};
};

}  // namespace

CameraModel camera_of(cv::Size size) {
  CameraModel camera = sim::default_camera_model();
  const double scale = static_cast<double>(size.width) / camera.width_px;
  const auto scaled_centre = [scale](double centre_px, int from_px, int to_px) {
    return 0.5 * (to_px - 1) + scale * (centre_px - 0.5 * (from_px - 1));
  };
  camera.cx = scaled_centre(camera.cx, camera.width_px, size.width);
  camera.cy = scaled_centre(camera.cy, camera.height_px, size.height);
  camera.fx *= scale;
  camera.fy *= scale;
  camera.width_px = size.width;
  camera.height_px = size.height;
  return camera;
}

namespace {

sim::Scenario scenario_of(cv::Size size) {
  using sim::WalkStep;
  sim::Scenario scenario;
  scenario.name = "walk in a room";
  scenario.seed = 7;
  scenario.robot.x_m = -kStartGap_m;
  scenario.camera.model = camera_of(size);
  scenario.camera.rate_hz = kWorldRate_Hz;
  scenario.path = {
      {.step = WalkStep::Straight, .speed_m_s = kWalkSpeedM_S, .length_m = 1.5},
      {.step = WalkStep::Arc,
       .speed_m_s = kWalkSpeedM_S,
       .radius_m = kCircleRadius_m,
       .angle_rad = 2.0 * std::numbers::pi},
      {.step = WalkStep::Arc,
       .speed_m_s = kWalkSpeedM_S,
       .radius_m = kCircleRadius_m,
       .angle_rad = -2.0 * std::numbers::pi},
  };
  return scenario;
}

}  // namespace

FrameView BenchFrame::view(std::uint64_t sequence) const {
  FrameView view;
  view.header.sequence = sequence;
  view.header.t_capture_ns = t_capture_ns;
  view.header.width_px = static_cast<std::uint32_t>(grey.cols);
  view.header.height_px = static_cast<std::uint32_t>(grey.rows);
  view.grey = grey.data;
  view.stride_bytes = static_cast<std::uint32_t>(grey.step);
  return view;
}

BenchInput walk_in_a_room(cv::Size size, int frames) {
  constexpr double kStep_s = 1.0 / (10.0 * kWorldRate_Hz);
  const sim::Scenario scenario = scenario_of(size);
  sim::World world(scenario);
  world.start_walk(0.0);
  BenchInput input;
  input.source = "simulated world";
  input.shirt = sim::teach_from_world(scenario, kTeachDistance_m);
  input.camera = scenario.camera.model;

  Follower follower;
  std::vector<std::uint8_t> grey;
  int steps = 0;
  for (int i = 0; i < frames; ++i) {
    const double t_s = kFirstFrame_s + i / kWorldRate_Hz;
    for (; steps * kStep_s < t_s; ++steps) follower.step(world.walk().at(steps * kStep_s), kStep_s);
    world.render(follower.motion(), t_s, static_cast<std::uint64_t>(i), grey);
    input.frames.push_back({cv::Mat(size, CV_8U, grey.data()).clone(), ns_from_seconds(t_s)});
  }
  return input;
}

}  // namespace heel::evaluation
