// Obstacles that the sonars detect: where they are, and how far the robot may drive along an arc before it
// meets one.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <span>

#include "control/sonar_beams.h"
#include "core/robot_geometry.h"
#include "heel/flow.h"

namespace heel {

/// A point that reflected a sonar beam, in the robot frame.
struct ObstaclePoint {
  double x_m = 0.0;
  double y_m = 0.0;
  double reach_m = 0.0;  ///< how far it may come until the robot has stopped; 0: it stands
};

/// The way ahead; infinite when nothing is in it or the robot does not drive.
struct Way {
  double free_m = std::numeric_limits<double>::infinity();  ///< from the bumper to the first obstacle
  /// How far the robot may drive until it has the clearance to what is in the way; negative: it is too near.
  /// What is only within the free space kept beside the body would not be met: the robot passes it slowly.
  double room_m = std::numeric_limits<double>::infinity();
};

/// The obstacles around the robot at one moment: at most one point a sonar. Does not allocate.
class SonarObstacles {
 public:
  /// None yet, around a robot of this outline.
  explicit SonarObstacles(const RobotGeometry& robot)
      : front_m_(robot.front_m), rear_m_(robot.rear_m), half_width_m_(robot.half_width_m) {}

  void add(ObstaclePoint point) { points_[count_++] = point; }
  /// The followed person moves, too, but away: what is heard at `back` is not expected to come.
  void expect_person(ObstaclePoint back);
  double half_width_m() const { return half_width_m_; }  ///< of the robot
  std::span<const ObstaclePoint> points() const { return {points_.data(), count_}; }

  /// For a robot that keeps `v_m_s` (negative: backwards) and `yaw_rate_rad_s`.
  Way way(double v_m_s, double yaw_rate_rad_s, double clearance_m) const;

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
    beams_.clear();
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
    bool has_come = false;  // something that moves
  };
  RobotGeometry robot_;
  std::array<Echo, kMaxSonars> echoes_{};
  SonarBeams beams_;
};

}  // namespace heel
