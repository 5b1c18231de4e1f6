// Obstacles that the sonars detect: where they are, and how far the robot may drive along an arc before it
// meets one.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "core/robot_geometry.h"
#include "heel/flow.h"

namespace heel {

/// A point that reflected a sonar beam, in the robot frame.
struct ObstaclePoint {
  double x_m = 0.0;
  double y_m = 0.0;
};

/// The obstacles around the robot at one moment: at most one point a sonar. Does not allocate.
class SonarObstacles {
 public:
  /// None yet, around a robot of this outline.
  explicit SonarObstacles(const RobotGeometry& robot)
      : front_m_(robot.front_m), rear_m_(robot.rear_m), half_width_m_(robot.half_width_m) {}

  void add(ObstaclePoint point) { points_[count_++] = point; }
  double half_width_m() const { return half_width_m_; }  ///< of the robot
  std::span<const ObstaclePoint> points() const { return {points_.data(), count_}; }

  /// Metres from the bumper to the first obstacle, for a robot that keeps `v_m_s` (negative: backwards) and
  /// `yaw_rate_rad_s`; infinite when none is in the way or the robot does not drive.
  double free_distance_m(double v_m_s, double yaw_rate_rad_s) const;

 private:
  double front_m_;
  double rear_m_;
  double half_width_m_;
  std::array<ObstaclePoint, kMaxSonars> points_{};
  std::size_t count_ = 0;
};

/// Keeps the newest reading of each sonar as a point in odom, because a sonar is read only three times a
/// second and the robot drives on meanwhile. The point is taken to lie in the middle of the beam.
class SonarObstacleMap {
 public:
  /// A reading older than this is dropped.
  static constexpr TimeNs kKept_ns = kNsPerS;

  explicit SonarObstacleMap(const RobotGeometry& robot) : robot_(robot) {}

  /// Another robot: what was kept is discarded.
  void use(const RobotGeometry& robot) {
    robot_ = robot;
    clear();
  }

  /// Takes in the readings that are new in `robot`.
  void update(const RobotState& robot);
  /// Discards every reading, also those that the robot's state repeats until its sonars are read again.
  void clear() {
    for (Echo& echo : echoes_) echo.known = false;
  }
  /// The obstacles in the robot frame at `now_ns`. Since `newest` the robot is taken to have kept its speed
  /// and yaw rate.
  SonarObstacles obstacles_at(TimeNs now_ns, const Odometry& newest) const;

 private:
  /// Of one sonar, in odom.
  struct Echo {
    TimeNs t_ns = 0;  // of the newest reading
    double x_m = 0.0, y_m = 0.0;
    bool known = false;
  };
  RobotGeometry robot_;
  std::array<Echo, kMaxSonars> echoes_{};
};

}  // namespace heel
