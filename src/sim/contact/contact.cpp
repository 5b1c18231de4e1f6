#include "sim/contact/contact.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace heel::sim {
namespace {

constexpr double kBumperTravel_m = 0.02;  ///< how far a bumper gives way
constexpr int kSegments = 5;              ///< of a bumper
constexpr int kPointsPerSegment = 3;
constexpr int kPointsPerSide = 8;
constexpr double kBeyond_m = 0.01;  ///< things so far from the outline are looked at

Eigen::Vector2d in_world(const Pose2& pose, double ahead_m, double left_m) {
  const double c = std::cos(pose.heading_rad);
  const double s = std::sin(pose.heading_rad);
  return {pose.x_m + c * ahead_m - s * left_m, pose.y_m + s * ahead_m + c * left_m};
}

bool is_inside_any(const std::vector<Footprint>& things, const Eigen::Vector2d& point) {
  return std::any_of(things.begin(), things.end(), [&](const Footprint& thing) {
    return (thing.nearest_m(point) - point).squaredNorm() < 1e-12;
  });
}

/// Pressed segments of the front (`end` +1) or rear (−1) bumper.
std::uint8_t pressed(const Pose2& pose, const RobotModel& robot, const std::vector<Footprint>& things,
                     double end) {
  const double bumper_m = end > 0.0 ? robot.geometry.front_m : robot.geometry.rear_m;
  unsigned bits = 0;
  for (int i = 0; i < kSegments * kPointsPerSegment; ++i) {
    const double across = 1.0 - 2.0 * (i + 0.5) / (kSegments * kPointsPerSegment);
    if (is_inside_any(things, in_world(pose, end * bumper_m, end * across * 0.5 * robot.width_m)))
      bits |= 1u << (i / kPointsPerSegment);
  }
  return static_cast<std::uint8_t>(bits);
}

/// Whether the rigid part of the robot is inside an obstacle.
bool blocked(const Pose2& pose, const RobotModel& robot, const std::vector<Footprint>& things) {
  const double front_m = robot.geometry.front_m - kBumperTravel_m;
  const double rear_m = robot.geometry.rear_m - kBumperTravel_m;
  const double half_width_m = 0.5 * robot.width_m;
  for (int i = 0; i <= kPointsPerSide; ++i) {
    const double share = 2.0 * i / kPointsPerSide - 1.0;
    const double along_m = share * (share > 0.0 ? front_m : rear_m);
    for (const double side : {-1.0, 1.0})
      if (is_inside_any(things, in_world(pose, side > 0.0 ? front_m : -rear_m, share * half_width_m)) ||
          is_inside_any(things, in_world(pose, along_m, side * half_width_m)))
        return true;
  }
  return false;
}

}  // namespace

Contact::Contact(const World& world, P3At& robot)
    : world_(world), robot_(robot), free_pose_(robot.true_pose()) {
  robot_.set_range_finder([this](const Pose2& sensor) {
    return world_.range_m(sensor.x_m, sensor.y_m, sensor.heading_rad, t_s_);
  });
}

std::vector<Footprint> Contact::nearby_footprints() const {
  const Pose2& pose = robot_.true_pose();
  const Eigen::Vector2d at(pose.x_m, pose.y_m);
  const RobotModel& robot = robot_.model();
  const double reach_m =
      std::hypot(std::max(robot.geometry.front_m, robot.geometry.rear_m), 0.5 * robot.width_m) + kBeyond_m;
  std::vector<Footprint> things;
  const auto add = [&](const std::vector<Footprint>& all) {
    for (const Footprint& thing : all) {
      // A quick test first: most of them are far away.
      const bool far = (thing.centre_m - at).norm() > reach_m + thing.reach_m();
      if (!far && (thing.nearest_m(at) - at).norm() < reach_m) things.push_back(thing);
    }
  };
  add(world_.room().footprints());
  add(world_.people_footprints(t_s_));
  return things;
}

void Contact::choose_floor() {
  const ScenarioRobot& robot = world_.scenario().robot;
  if (robot.patches.empty()) return;
  const Pose2& pose = robot_.true_pose();
  const auto under = std::find_if(robot.patches.begin(), robot.patches.end(), [&](const FloorPatch& patch) {
    return std::abs(pose.x_m - patch.x_m) <= 0.5 * patch.length_m &&
           std::abs(pose.y_m - patch.y_m) <= 0.5 * patch.width_m;
  });
  robot_.set_true_track(under == robot.patches.end() ? robot.true_track_m : under->true_track_m);
}

void Contact::step(double t_s) {
  t_s_ = t_s;
  choose_floor();
  const std::vector<Footprint> things = nearby_footprints();
  if (blocked(robot_.true_pose(), robot_.model(), things))
    robot_.place(free_pose_);
  else
    free_pose_ = robot_.true_pose();
  robot_.touch_bumper(pressed(robot_.true_pose(), robot_.model(), things, 1.0),
                      pressed(robot_.true_pose(), robot_.model(), things, -1.0));
}

}  // namespace heel::sim
