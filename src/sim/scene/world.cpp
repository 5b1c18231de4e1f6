// The truth: where everybody is, where the camera sees it, and what hides it. Pictures are drawn in
// renderer.cpp.
#include "sim/scene/world.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/random.h"
#include "heel/error.h"
#include "sim/scene/renderer.h"
#include "sim/scene/rigid_fit.h"

namespace heel::sim {
namespace {

FloorPlan plan_of(const Scenario& scenario, const std::deque<WalkingPerson>& people) {
  FloorPlan plan;
  plan.walked_m.emplace_back(scenario.robot.x_m, scenario.robot.y_m);
  for (const WalkingPerson& person : people) {
    const std::vector<WalkState>& samples = person.walk.samples();
    // Every tenth sample: some centimetres apart.
    for (std::size_t i = 0; i < samples.size(); i += 10)
      plan.walked_m.emplace_back(samples[i].x_m, samples[i].y_m);
    const std::vector<StoolPlace>& stools = person.walk.stools();
    plan.stools.insert(plan.stools.end(), stools.begin(), stools.end());
  }
  plan.obstacles = scenario.obstacles;
  return plan;
}

/// The target, then the passers-by. A passer-by's seed depends on the place in the file only.
std::deque<WalkingPerson> people_of(const Scenario& scenario, WorldUse use) {
  const std::uint64_t target_seed = derived_seed(scenario.seed, 0x50);
  const std::uint64_t shirt_seed = derived_seed(target_seed, 0x51);
  std::deque<WalkingPerson> people;
  people.push_back({Person(scenario.person, target_seed, shirt_seed, use),
                    Walk(scenario.person_start, scenario.path), 0.0});
  for (std::size_t i = 0; i < scenario.passers_by.size(); ++i) {
    const PasserbySettings& passerby = scenario.passers_by[i];
    const std::uint64_t seed = derived_seed(scenario.seed, 0x1000 + i);
    PersonSettings settings = passerby.person;
    if (passerby.shirt_origin != ShirtOrigin::Own) settings.shirt = scenario.person.shirt;
    const bool same = passerby.shirt_origin == ShirtOrigin::Same;
    people.push_back({Person(settings, seed, same ? shirt_seed : derived_seed(seed, 0x51), use),
                      Walk(passerby.start, passerby.path), passerby.walk_after_s});
  }
  return people;
}

/// Columns are the camera's axes in the robot frame: x right, y down, z forwards.
Eigen::Matrix3d robot_from_level_camera() {
  Eigen::Matrix3d R;
  R << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return R;
}

/// The axes of a level camera that looks along `heading_rad`.
Eigen::Matrix3d world_from_level_camera(double heading_rad) {
  return Eigen::AngleAxisd(heading_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix() *
         robot_from_level_camera();
}

}  // namespace

RobotMotion moved(const RobotMotion& robot, double dt_s) {
  RobotMotion out = robot;
  const double mid_heading = robot.heading_rad + 0.5 * dt_s * robot.yaw_rate_rad_s;
  out.x_m += dt_s * robot.v_m_s * std::cos(mid_heading);
  out.y_m += dt_s * robot.v_m_s * std::sin(mid_heading);
  out.heading_rad += dt_s * robot.yaw_rate_rad_s;
  return out;
}

World::World(const Scenario& scenario, int threads, WorldUse use)
    : scenario_(scenario),
      people_(people_of(scenario, use)),
      taught_back_m_(back_points_m(taught_pose())),
      light_(scenario.light, scenario.seed),
      room_(scenario.room, plan_of(scenario, people_), light_, scenario.light.window_azimuth_rad,
            derived_seed(scenario.seed, 0x20), use),
      ground_(scenario.room.bump_m, derived_seed(scenario.seed, 0x30)),
      exposure_(scenario.camera.exposure, scenario.camera.sensor.exposure_ms, scenario.light.changes,
                scenario.duration_s),
      view_(ray_bounds(scenario.camera.model)) {
  if (use == WorldUse::Rendering) renderer_ = std::make_unique<Renderer>(*this, threads);
}

World::~World() = default;

Eigen::Isometry3d World::world_from_camera(const RobotMotion& robot) const {
  const ScenarioCamera& camera = scenario_.camera;
  const GroundPose ground_pose = ground_.pose_at(robot.x_m, robot.y_m, robot.heading_rad);
  Eigen::Isometry3d robot_from_camera = Eigen::Isometry3d::Identity();
  robot_from_camera.translation() << camera.mount_x_m, camera.mount_y_m, camera.mount_z_m;
  // The camera's x axis points right: a positive rotation about it turns the view upwards.
  robot_from_camera.linear() =
      robot_from_level_camera() * (Eigen::AngleAxisd(camera.mount_pitch_rad, Eigen::Vector3d::UnitX()) *
                                   Eigen::AngleAxisd(camera.mount_roll_rad, Eigen::Vector3d::UnitZ()))
                                      .toRotationMatrix();
  return Eigen::Translation3d(robot.x_m, robot.y_m, ground_pose.lift_m) *
         Eigen::AngleAxisd(robot.heading_rad, Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(-ground_pose.pitch_rad, Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(ground_pose.roll_rad, Eigen::Vector3d::UnitX()) * robot_from_camera;
}

PersonPose World::pose_of(std::size_t index, double t_s) const {
  const WalkingPerson& walker = people_[index];
  WalkState state = walker.walk.at(t_s - walk_start_s_ - walker.walk_after_s);
  if (walk_held_) state.speed_m_s = 0.0;
  return walker.person.pose(state, t_s);
}

Eigen::Vector2d World::project_px(const Eigen::Vector3d& point_in_camera_m) const {
  const CameraModel& camera = scenario_.camera.model;
  const Eigen::Vector2d ideal(camera.fx * point_in_camera_m.x() / point_in_camera_m.z() + camera.cx,
                              camera.fy * point_in_camera_m.y() / point_in_camera_m.z() + camera.cy);
  return camera.distort_px(ideal);
}

bool World::pixel_of_moving_point(const RobotMotion& robot, double t_s,
                                  const std::function<Eigen::Vector3d(double t_s)>& point_m,
                                  Eigen::Vector2d& px) const {
  const double readout_s = 1e-3 * scenario_.camera.readout_ms;
  const int rows = scenario_.camera.model.height_px - 1;
  double offset_s = 0.0;
  // The row depends on the time of its exposure, and the time on the row. The image moves by a few rows at
  // most during the readout, so that a few steps find both.
  for (int i = 0; i < 6; ++i) {
    const Eigen::Vector3d in_camera =
        world_from_camera(moved(robot, offset_s)).inverse() * point_m(t_s + offset_s);
    // Distortion is not defined far outside the picture.
    if (in_camera.z() < 0.1 || std::abs(in_camera.x()) > view_.x_max * 1.2 * in_camera.z() ||
        std::abs(in_camera.y()) > view_.y_max * 1.2 * in_camera.z())
      return false;
    px = project_px(in_camera);
    if (readout_s == 0.0) return true;
    offset_s = readout_s * (std::clamp(px.y() / rows, 0.0, 1.0) - 0.5);
  }
  return true;
}

std::vector<Eigen::Vector3d> World::back_points_m(const PersonPose& pose) const {
  std::vector<Eigen::Vector3d> points = person().torso().back_points_m(pose.cloth);
  for (Eigen::Vector3d& point : points) point = pose.world_from_part[kTorso] * point;
  return points;
}

Truth World::truth(const RobotMotion& robot, double t_s) const {
  const PersonPose person = person_pose(t_s);
  Truth truth;
  truth.person = person.walk;
  const Eigen::Matrix3d world_from_ref = fit_rigid(taught_back_m_, back_points_m(person)).R *
                                         world_from_level_camera(scenario_.person_start.heading_rad);
  const Eigen::Vector3d forwards = world_from_ref.col(2);
  truth.back_yaw_rad = person.walk.heading_rad +
                       std::remainder(std::atan2(forwards.y(), forwards.x()) - person.walk.heading_rad,
                                      2.0 * std::numbers::pi);
  truth.back_m = back_m(person);
  truth.world_from_camera = world_from_camera(robot);
  truth.ground_pose = ground_.pose_at(robot.x_m, robot.y_m, robot.heading_rad);
  truth.exposure = exposure_.at(t_s);
  const Eigen::Isometry3d camera_from_world = truth.world_from_camera.inverse();
  truth.back_in_camera_m = camera_from_world * truth.back_m;
  truth.R_cur_from_ref = camera_from_world.linear() * world_from_ref;
  const Eigen::Vector3d direction = truth.R_cur_from_ref.col(2);
  truth.yaw_rad = std::atan2(direction.x(), direction.z());
  truth.occluded = occluded(truth.world_from_camera.translation(), truth.back_m, t_s);
  const auto back_at = [&](double at_s) -> Eigen::Vector3d {
    return at_s == t_s ? truth.back_m : back_m(person_pose(at_s));
  };
  Eigen::Vector2d px;
  if (pixel_of_moving_point(robot, t_s, back_at, px)) {
    truth.back_px = px;
    const CameraModel& camera = scenario_.camera.model;
    truth.in_view = px.x() >= 0 && px.y() >= 0 && px.x() <= camera.width_px - 1 &&
                    px.y() <= camera.height_px - 1 && direction.dot(truth.back_in_camera_m) > 0.0;
  }
  return truth;
}

std::vector<Footprint> World::people_footprints(double t_s) const {
  std::vector<Footprint> people;
  for (std::size_t i = 0; i < people_.size(); ++i) {
    const Eigen::Vector3d at = pose_of(i, t_s).world_from_part[kTorso].translation();
    people.push_back({at.head<2>(), 0.0, 0.0, 0.0, kPersonRadius_m, kPersonHeight_m});
  }
  return people;
}

double World::range_m(double x_m, double y_m, double heading_rad, double t_s) const {
  const Eigen::Vector2d from(x_m, y_m);
  double nearest = std::numeric_limits<double>::infinity();
  const auto search = [&](const std::vector<Footprint>& things) {
    for (const Footprint& thing : things) {
      if ((thing.centre_m - from).norm() - thing.reach_m() > kSonarReach_m) continue;
      nearest = std::min(nearest, thing.in_cone_m(from, heading_rad, kSonarHalfBeam_rad));
    }
  };
  search(room_.footprints());
  search(people_footprints(t_s));
  return nearest;
}

bool World::occluded(const Eigen::Vector3d& eye_m, const Eigen::Vector3d& point_m, double t_s) const {
  const Eigen::Vector2d from = eye_m.head<2>();
  const double distance = (point_m.head<2>() - from).norm();
  if (distance < 1e-6) return false;
  const Eigen::Vector2d direction = (point_m.head<2>() - from) / distance;
  const auto hides = [&](const Footprint& thing) {
    const double at = thing.ray_m(from, direction);
    // The line of sight must enter it below its top.
    return at < distance && eye_m.z() + (point_m.z() - eye_m.z()) * at / distance < thing.top_m;
  };
  if (std::any_of(room_.footprints().begin(), room_.footprints().end(), hides)) return true;
  const std::vector<Footprint> people = people_footprints(t_s);
  return std::any_of(people.begin() + 1, people.end(), hides);  // the target does not hide itself
}

/// The part of the back to make a template of: between the outer edges of the shoulder blades, from below the
/// collar to the waist.
World::PixelBox World::back_region_px(const Eigen::Isometry3d& view_from_torso,
                                      const ClothState& cloth) const {
  PixelBox box{Eigen::Vector2d(1e9, 1e9), Eigen::Vector2d(-1e9, -1e9)};
  for (const double s : {-160.0, 0.0, 160.0})
    for (const double t : {110.0, 340.0, 600.0}) {
      const Eigen::Vector3d point = person().shirt_point_m(0.5 * kShirtWidthTexels + s, t, cloth);
      const Eigen::Vector2d px = project_px(view_from_torso * point);
      box.low = box.low.cwiseMin(px);
      box.high = box.high.cwiseMax(px);
    }
  return box;
}

Eigen::Isometry3d World::reference_view_from_world(double distance_m) const {
  const double heading = scenario_.person_start.heading_rad;
  Eigen::Isometry3d world_from_view = Eigen::Isometry3d::Identity();
  world_from_view.linear() = world_from_level_camera(heading);
  world_from_view.translation() =
      back_m(taught_pose()) - distance_m * Eigen::Vector3d(std::cos(heading), std::sin(heading), 0.0);
  world_from_view.translation().z() = scenario_.camera.mount_z_m;
  return world_from_view.inverse();
}

ReferenceView World::reference_view(double distance_m) {
  const PersonPose still = taught_pose();
  const Eigen::Isometry3d& world_from_torso = still.world_from_part[kTorso];
  const Eigen::Isometry3d view_from_world = reference_view_from_world(distance_m);

  const PixelBox back = back_region_px(view_from_world * world_from_torso, still.cloth);
  const CameraModel& model = scenario_.camera.model;
  if (distance_m < 0.3 || back.low.x() < 0 || back.low.y() < 0 || back.high.x() > model.width_px - 1 ||
      back.high.y() > model.height_px - 1)
    throw Error(
        fmt::format("reference view at {} m: the back does not fit into the picture (expected a larger "
                    "distance)",
                    distance_m));
  ReferenceView view;
  view.roi.x_px = static_cast<int>(std::ceil(back.low.x()));
  view.roi.y_px = static_cast<int>(std::ceil(back.low.y()));
  view.roi.width_px = static_cast<int>(std::floor(back.high.x())) - view.roi.x_px + 1;
  view.roi.height_px = static_cast<int>(std::floor(back.high.y())) - view.roi.y_px + 1;
  view.distance_m = distance_m;
  // A frame number that no run reaches, so that no frame has the same noise as the reference view.
  draw_still(still, view_from_world, std::numeric_limits<std::uint32_t>::max(), view.grey);
  return view;
}

void World::render(const RobotMotion& robot, double t_s, std::uint64_t frame,
                   std::vector<std::uint8_t>& grey) {
  renderer_->draw(robot, t_s, frame, grey);
}

void World::draw_still(const PersonPose& target, const Eigen::Isometry3d& view_from_world,
                       std::uint64_t frame, std::vector<std::uint8_t>& grey) {
  renderer_->draw_still(target, view_from_world, frame, grey);
}

}  // namespace heel::sim
