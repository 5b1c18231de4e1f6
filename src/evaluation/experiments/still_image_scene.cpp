#include "evaluation/experiments/still_image_scene.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "evaluation/experiments/occluding_board.h"
#include "realtime/thread_clock.h"
#include "sim/scene/shirts.h"

namespace heel::evaluation {
namespace {

constexpr double kClearance_m = 5.6;  ///< around the person: the camera is up to 5.5 m away
constexpr double kRoomMargin_m = 8.0;
// Each seed has a person with another depth of the body.
constexpr std::uint64_t kBodySeed = 0xb1d;
constexpr double kSmallestDepth = 0.75, kLargestDepth = 1.3;
// Longer than PoseTracker keeps a pose, so that it searches the whole frame in the next case.
constexpr double kBetweenCases_s = 1.0;

}  // namespace

sim::Scenario still_image_scenario(const sim::Scenario& base, const StillImageWorld& world) {
  sim::Scenario scenario = base;
  scenario.name = "still";
  scenario.seed = world.seed;
  scenario.path.clear();
  scenario.passers_by.clear();
  scenario.obstacles.clear();
  scenario.light.changes.clear();
  scenario.room.bump_m = 0.0;
  scenario.person_start = {};
  scenario.person.shirt = sim::shirt_design(world.shirt);
  scenario.light.level = world.light;
  scenario.person.depth = Random(derived_seed(world.seed, kBodySeed)).uniform(kSmallestDepth, kLargestDepth);
  scenario.robot = {};
  scenario.room.clearance_m = kClearance_m;
  scenario.room.margin_m = kRoomMargin_m;
  return scenario;
}

sim::RobotMotion robot_for(const sim::ScenarioCamera& camera, const sim::Truth& person,
                           const StillImageView& view) {
  // From a camera turned to the left, the person faces to the right.
  const double heading = person.back_yaw_rad + view.yaw_rad;
  const Eigen::Vector2d ahead(std::cos(heading), std::sin(heading));
  const Eigen::Vector2d left(-ahead.y(), ahead.x());
  const Eigen::Vector2d camera_m = person.back_m.head<2>() - view.z_m * ahead + view.x_m * left;
  const Eigen::Vector2d robot_m = camera_m - camera.mount_x_m * ahead - camera.mount_y_m * left;
  sim::RobotMotion robot;
  robot.x_m = robot_m.x();
  robot.y_m = robot_m.y();
  robot.heading_rad = heading;
  robot.yaw_rate_rad_s = view.blur_px / (camera.model.fx * 1e-3 * camera.sensor.exposure_ms);
  return robot;
}

StillImageScene::StillImageScene(const sim::Scenario& base, const StillImageWorld& world,
                                 const ShirtTemplate& shirt, const VisionConfig& vision)
    : settings_(world),
      world_(still_image_scenario(base, world)),
      shirt_(shirt),
      vision_(shirt, base.camera.model, vision) {}

std::array<StillImageRow, 2> StillImageScene::estimate_pair(const std::string& name,
                                                            const StillImageView& view) {
  t_s_ += kBetweenCases_s;
  const StillImageRow first = estimate(name, view, 0);
  t_s_ += 1.0 / world_.scenario().camera.rate_hz;
  return {first, estimate(name, view, 1)};
}

StillImageRow StillImageScene::estimate(const std::string& name, const StillImageView& view, int picture) {
  StillImageRow row;
  row.name = name;
  row.world = settings_;
  row.view = view;
  row.picture = picture;
  set_truth(render(view), row);

  const CameraModel& camera = world_.scenario().camera.model;
  FrameView frame;
  frame.header = {frame_, ns_from_seconds(t_s_), static_cast<std::uint32_t>(camera.width_px),
                  static_cast<std::uint32_t>(camera.height_px)};
  frame.grey = grey_.data();
  frame.stride_bytes = frame.header.width_px;
  const TimeNs t_begin_ns = thread_cpu_ns();
  row.pose = vision_.estimate(frame);
  row.vision_ms = 1e-6 * static_cast<double>(thread_cpu_ns() - t_begin_ns);
  set_estimate(row);
  return row;
}

/// Draws the next picture and returns its truth.
sim::Truth StillImageScene::render(const StillImageView& view) {
  const sim::ScenarioCamera& camera = world_.scenario().camera;
  const sim::RobotMotion robot = robot_for(camera, world_.truth({}, t_s_), view);
  sim::Truth truth = world_.truth(robot, t_s_);
  world_.render(robot, t_s_, ++frame_, grey_);
  if (view.occluded != 0.0)
    draw_occluding_board(truth, camera.model, view.occluded, derived_seed(settings_.seed, frame_),
                         settings_.light, grey_);
  return truth;
}

void StillImageScene::set_truth(const sim::Truth& truth, StillImageRow& row) const {
  row.true_x_m = truth.back_in_camera_m.x();
  row.true_y_m = truth.back_in_camera_m.y();
  row.true_z_m = truth.back_in_camera_m.z();
  row.true_yaw_rad = truth.yaw_rad;
  // The middle of the back in the reference view: straight ahead, apart from the camera's height.
  const double back_below_camera_m =
      world_.scenario().camera.mount_z_m - world_.back_m(world_.taught_pose()).z();
  const Eigen::Vector3d back_ref_m(0.0, back_below_camera_m, shirt_.distance_m);
  row.true_t_m = truth.back_in_camera_m - truth.R_cur_from_ref * back_ref_m;
}

/// What follows from the estimated pose.
void StillImageScene::set_estimate(StillImageRow& row) const {
  for (std::size_t i = 0; i < 3; ++i) {
    row.t_m[i] = shirt_.distance_m * row.pose.t_over_d[i];
    row.t_sigma_m[i] = shirt_.distance_m * row.pose.t_over_d_sigma[i];
  }
  const CameraModel& camera = world_.scenario().camera.model;
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> H(row.pose.H_cur_from_ref.data());
  const double left = shirt_.roi.x_px, right = shirt_.roi.x_px + shirt_.roi.width_px;
  const double top = shirt_.roi.y_px, bottom = shirt_.roi.y_px + shirt_.roi.height_px;
  const std::array<Eigen::Vector2d, 4> corners{Eigen::Vector2d(left, top), Eigen::Vector2d(right, top),
                                               Eigen::Vector2d(right, bottom), Eigen::Vector2d(left, bottom)};
  for (std::size_t i = 0; i < 4; ++i) {
    row.outline_px[i].setZero();
    if (row.pose.found())
      row.outline_px[i] =
          camera.distort_px((H * shirt_.camera.undistort_px(corners[i]).homogeneous()).hnormalized());
  }
}

}  // namespace heel::evaluation
