// What the sonars heard, where in odom that was, and how far the robot may drive along an arc before it is
// there.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "heel/flow.h"

namespace heel {

/// A thing that echoed, in the robot frame.
struct ObstaclePoint {
  double x_m = 0.0;
  double y_m = 0.0;
};

/// What the robot may meet now: at most one point a sonar. Does not allocate.
class SonarObstacles {
 public:
  void add(ObstaclePoint point) { points_[count_++] = point; }
  std::span<const ObstaclePoint> points() const { return {points_.data(), count_}; }

  /// Metres from the bumper to the first of them, driving on at `v_m_s` (backwards when negative) and turning
  /// at `yaw_rate_rad_s` for ever; infinite when none is in the way, or when the robot does not drive.
  double free_distance_m(double v_m_s, double yaw_rate_rad_s) const;

 private:
  std::array<ObstaclePoint, kSonars> points_{};
  std::size_t count_ = 0;
};

/// Remembers each sonar's newest echo at its place in odom: between two of them, a third of a second apart,
/// the robot drives on. An echo is taken to come from the middle of the beam.
class SonarObstacleMap {
 public:
  /// A sonar that was not heard again for this long says nothing more.
  static constexpr TimeNs kKept_ns = kNsPerS;

  void see(const RobotState& robot);
  void clear() { places_ = {}; }
  /// In the robot frame at `now_ns`, the robot taken to have kept its speed and yaw rate since its last
  /// packet.
  SonarObstacles at(TimeNs now_ns, const Odometry& newest) const;

 private:
  struct Place {
    TimeNs t_ns = 0;  // 0: none
    double x_m = 0.0, y_m = 0.0;
  };
  std::array<Place, kSonars> places_{};
};

}  // namespace heel
