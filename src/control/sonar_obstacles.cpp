#include "control/sonar_obstacles.h"

#include <algorithm>
#include <cmath>

#include "estimate/odometry_history.h"

namespace heel {
namespace {

constexpr double kCorridorMargin_m = 0.08;  // free space kept on either side of the robot
// An echo nearer to the robot's way than this may be of something that the robot would meet.
constexpr double kUncertain_m = 0.5 * kCorridorMargin_m;
// The room past an echo that is farther: at a quarter of a metre per second with the brakes of a P3-AT.
constexpr double kPassing_m = 0.04;
// What moves comes across the robot's way at a walking pace, for as long as it takes until it is heard again
// and the robot has stopped.
constexpr double kAcross_m_s = 1.0;
constexpr double kUntilStopped_s = 0.75;
// Echoes of the followed person: about as far away as their back, and within the width of a beam of it.
constexpr double kPersonDepth_m = 0.25;
constexpr double kPersonBeside_m = 0.6;
constexpr double kStraight_1_m = 1e-6;  // an arc flatter than this is a line

/// A point relative to the arc that the robot drives: how far along the arc, and how far to its side.
struct OnArc {
  double along_m, beside_m;
};

OnArc on_arc(ObstaclePoint point, double curvature_1_m) {
  if (std::abs(curvature_1_m) < kStraight_1_m) return {point.x_m, std::abs(point.y_m)};
  const double radius_m = 1.0 / curvature_1_m;  // the arc's centre is this far to the left
  const double side = std::copysign(1.0, radius_m);
  const double turn_rad = std::atan2(point.x_m, side * (radius_m - point.y_m));
  const double from_centre_m = std::hypot(point.x_m, radius_m - point.y_m);
  return {std::abs(radius_m) * turn_rad, std::abs(from_centre_m - std::abs(radius_m))};
}

}  // namespace

void SonarObstacles::expect_person(ObstaclePoint back) {
  const double range_m = std::hypot(back.x_m, back.y_m);
  for (std::size_t i = 0; i < count_; ++i) {
    ObstaclePoint& point = points_[i];
    const bool same_range = std::abs(std::hypot(point.x_m, point.y_m) - range_m) < kPersonDepth_m;
    if (same_range && std::hypot(point.x_m - back.x_m, point.y_m - back.y_m) < kPersonBeside_m)
      point.reach_m = 0.0;
  }
}

Way SonarObstacles::way(double v_m_s, double yaw_rate_rad_s, double clearance_m) const {
  Way way;
  if (v_m_s == 0.0) return way;
  const double direction = std::copysign(1.0, v_m_s);
  const double to_bumper_m = direction > 0.0 ? front_m_ : rear_m_;
  for (const ObstaclePoint& point : points()) {
    // Backwards is forwards in a frame that is mirrored in x, where turns go the other way.
    const ObstaclePoint ahead{direction * point.x_m, point.y_m};
    const bool beside_body = ahead.x_m < to_bumper_m && std::abs(ahead.y_m) > half_width_m_;
    if (ahead.x_m <= 0.0 || beside_body) continue;
    const OnArc place = on_arc(ahead, yaw_rate_rad_s / v_m_s);
    const double beside_m = place.beside_m - half_width_m_;
    const double outside_m = beside_m - kCorridorMargin_m;
    if (place.along_m <= 0.0 || outside_m >= point.reach_m) continue;
    const double across_m = std::max(outside_m, 0.0);
    const double comes_m = std::sqrt(point.reach_m * point.reach_m - across_m * across_m);
    const double free_m = std::max(place.along_m - comes_m - to_bumper_m, 0.0);
    double room_m = free_m - clearance_m;
    const bool is_only_beside = beside_m > 0.0 && point.reach_m == 0.0;
    if (is_only_beside) {
      const double in_way = 1.0 - std::min(beside_m / kUncertain_m, 1.0);
      room_m = std::max(room_m, kPassing_m - in_way * in_way * clearance_m);
    }
    way.free_m = std::min(way.free_m, free_m);
    way.room_m = std::min(way.room_m, room_m);
  }
  return way;
}

void SonarObstacleMap::update(const RobotState& robot) {
  const Odometry& pose = robot.odometry;
  const double c = std::cos(pose.heading_rad), s = std::sin(pose.heading_rad);
  for (std::size_t sonar = 0; sonar < kMaxSonars; ++sonar) {
    const SonarEcho& reading = robot.sonar[sonar];
    if (reading.t_ns == echoes_[sonar].t_ns || !robot_.has_sonar(sonar)) continue;
    const Pose2& mount = robot_.sonars[sonar];
    const SonarBeam beam{reading.t_ns,
                         {pose.x_m + c * mount.x_m - s * mount.y_m, pose.y_m + s * mount.x_m + c * mount.y_m,
                          pose.heading_rad + mount.heading_rad},
                         reading.range_m};
    const double x_m = mount.x_m + reading.range_m * std::cos(mount.heading_rad);
    const double y_m = mount.y_m + reading.range_m * std::sin(mount.heading_rad);
    echoes_[sonar] = {reading.t_ns, pose.x_m + c * x_m - s * y_m, pose.y_m + s * x_m + c * y_m, true,
                      beams_.has_come(beam)};
    beams_.add(beam);
  }
}

SonarObstacles SonarObstacleMap::obstacles_at(TimeNs now_ns, const Odometry& newest) const {
  const Pose2 pose = extrapolated(newest, std::max(0.0, seconds_from_ns(now_ns - newest.t_ns)));
  const double c = std::cos(pose.heading_rad), s = std::sin(pose.heading_rad);
  SonarObstacles obstacles(robot_);
  for (const Echo& echo : echoes_) {
    if (!echo.known || now_ns - echo.t_ns > kKept_ns) continue;
    const double dx_m = echo.x_m - pose.x_m, dy_m = echo.y_m - pose.y_m;
    obstacles.add(
        {c * dx_m + s * dy_m, c * dy_m - s * dx_m, echo.has_come ? kAcross_m_s * kUntilStopped_s : 0.0});
  }
  return obstacles;
}

}  // namespace heel
