#include "control/sonar_obstacles.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "estimate/odometry_history.h"

namespace heel {
namespace {

constexpr double kCorridorMargin_m = 0.08;  // free space kept on either side of the robot
constexpr double kStraight_1_m = 1e-6;      // an arc flatter than this is a line

ObstaclePoint in_robot_frame(const Pose2& sonar, double range_m) {
  return {sonar.x_m + range_m * std::cos(sonar.heading_rad),
          sonar.y_m + range_m * std::sin(sonar.heading_rad)};
}

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

double SonarObstacles::free_distance_m(double v_m_s, double yaw_rate_rad_s) const {
  double free_m = std::numeric_limits<double>::infinity();
  if (v_m_s == 0.0) return free_m;
  const double direction = std::copysign(1.0, v_m_s);
  const double to_bumper_m = direction > 0.0 ? front_m_ : rear_m_;
  for (const ObstaclePoint& point : points()) {
    // Backwards is forwards in a frame that is mirrored in x, where turns go the other way.
    const ObstaclePoint ahead{direction * point.x_m, point.y_m};
    const bool beside_body = ahead.x_m < to_bumper_m && std::abs(ahead.y_m) > half_width_m_;
    if (ahead.x_m <= 0.0 || beside_body) continue;
    const OnArc place = on_arc(ahead, yaw_rate_rad_s / v_m_s);
    if (place.along_m > 0.0 && place.beside_m < half_width_m_ + kCorridorMargin_m)
      free_m = std::min(free_m, std::max(place.along_m - to_bumper_m, 0.0));
  }
  return free_m;
}

void SonarObstacleMap::update(const RobotState& robot) {
  const Odometry& pose = robot.odometry;
  const double c = std::cos(pose.heading_rad), s = std::sin(pose.heading_rad);
  for (std::size_t sonar = 0; sonar < kMaxSonars; ++sonar) {
    const SonarEcho& reading = robot.sonar[sonar];
    if (reading.t_ns == echoes_[sonar].t_ns || !robot_.has_sonar(sonar)) continue;
    const ObstaclePoint point = in_robot_frame(robot_.sonars[sonar], reading.range_m);
    echoes_[sonar] = {reading.t_ns, pose.x_m + c * point.x_m - s * point.y_m,
                      pose.y_m + s * point.x_m + c * point.y_m, true};
  }
}

SonarObstacles SonarObstacleMap::obstacles_at(TimeNs now_ns, const Odometry& newest) const {
  const Pose2 pose = extrapolated(newest, std::max(0.0, seconds_from_ns(now_ns - newest.t_ns)));
  const double c = std::cos(pose.heading_rad), s = std::sin(pose.heading_rad);
  SonarObstacles obstacles(robot_);
  for (const Echo& echo : echoes_) {
    if (!echo.known || now_ns - echo.t_ns > kKept_ns) continue;
    const double dx_m = echo.x_m - pose.x_m, dy_m = echo.y_m - pose.y_m;
    obstacles.add({c * dx_m + s * dy_m, c * dy_m - s * dx_m});
  }
  return obstacles;
}

}  // namespace heel
