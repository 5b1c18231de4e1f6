#include "control/sonar_obstacles.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "estimate/odometry_history.h"

namespace heel {
namespace {

constexpr double kFromMiddleToBumper_m = 0.313;
constexpr double kHalfWidth_m = 0.25;
constexpr double kHalfCorridor_m = 0.33;  // a hand more
constexpr double kStraight_1_m = 1e-6;    // an arc flatter than this is a line

struct Mount {
  double x_m, y_m, heading_deg;
};
/// The left half of the front array from left to right; everything else is its mirror image (P3-AT manual).
constexpr Mount kFrontLeft[] = {
    {0.147, 0.136, 90}, {0.193, 0.119, 50}, {0.227, 0.079, 30}, {0.245, 0.027, 10}};
/// The right half of the rear array, likewise: it sits 3 to 4 mm nearer to the middle.
constexpr Mount kRearRight[] = {
    {-0.144, -0.136, -90}, {-0.189, -0.119, -130}, {-0.223, -0.079, -150}, {-0.241, -0.027, -170}};

/// Of sonar 0…15: the front from left to right, the rear from right to left.
Mount mount_of_sonar(std::size_t number) {
  constexpr std::size_t kHalf = 4;
  const bool rear = number >= 2 * kHalf;
  const std::size_t place = number % (2 * kHalf);
  if (place < kHalf) return (rear ? kRearRight : kFrontLeft)[place];
  const Mount& twin = (rear ? kRearRight : kFrontLeft)[2 * kHalf - 1 - place];
  return {twin.x_m, -twin.y_m, -twin.heading_deg};
}

ObstaclePoint in_robot_frame(std::size_t sonar, double range_m) {
  const Mount mount = mount_of_sonar(sonar);
  const double heading_rad = mount.heading_deg * std::numbers::pi / 180.0;
  return {mount.x_m + range_m * std::cos(heading_rad), mount.y_m + range_m * std::sin(heading_rad)};
}

/// A point by the arc the robot is on: how far along it, and how far beside it.
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
  for (const ObstaclePoint& point : points()) {
    // Backwards is forwards in a frame that is mirrored in x, where turns go the other way.
    const ObstaclePoint ahead{direction * point.x_m, point.y_m};
    const bool beside_body = ahead.x_m < kFromMiddleToBumper_m && std::abs(ahead.y_m) > kHalfWidth_m;
    if (ahead.x_m <= 0.0 || beside_body) continue;
    const OnArc place = on_arc(ahead, yaw_rate_rad_s / v_m_s);
    if (place.along_m > 0.0 && place.beside_m < kHalfCorridor_m)
      free_m = std::min(free_m, std::max(place.along_m - kFromMiddleToBumper_m, 0.0));
  }
  return free_m;
}

void SonarObstacleMap::see(const RobotState& robot) {
  const Odometry& at = robot.odometry;
  const double c = std::cos(at.heading_rad), s = std::sin(at.heading_rad);
  for (std::size_t sonar = 0; sonar < kSonars; ++sonar) {
    const SonarEcho& echo = robot.sonar[sonar];
    if (echo.t_ns == places_[sonar].t_ns) continue;
    const ObstaclePoint point = in_robot_frame(sonar, echo.range_m);
    places_[sonar] = {echo.t_ns, at.x_m + c * point.x_m - s * point.y_m,
                      at.y_m + s * point.x_m + c * point.y_m};
  }
}

SonarObstacles SonarObstacleMap::at(TimeNs now_ns, const Odometry& newest) const {
  const Pose2 robot = extrapolated(newest, std::max(0.0, seconds_from_ns(now_ns - newest.t_ns)));
  const double c = std::cos(robot.heading_rad), s = std::sin(robot.heading_rad);
  SonarObstacles echoes;
  for (const Place& place : places_) {
    if (place.t_ns == 0 || now_ns - place.t_ns > kKept_ns) continue;
    const double dx_m = place.x_m - robot.x_m, dy_m = place.y_m - robot.y_m;
    echoes.add({c * dx_m + s * dy_m, c * dy_m - s * dx_m});
  }
  return echoes;
}

}  // namespace heel
