// The path that a person walked, in odom, by arc length: where the body went, without the sway of the gait.
//
// Points lie about kSpacing_m apart. Place and direction of the trail at an arc length come from a weighted
// quadratic through the points around it (local regression: W. Cleveland, S. Devlin, "Locally Weighted
// Regression", JASA 83, 1988), which removes what is left of the sway and does not cut a bend of constant
// curvature. Before its first point the trail is a straight line, the lead-in: it leads from where the robot
// stood when the person was first seen, or along their direction of travel when that is clearly another one.
//
// A person who walks back takes the trail back: its last points are removed.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "core/pose2.h"

namespace heel {

/// A ring of fixed size. Does not allocate.
class Trail {
 public:
  static constexpr std::size_t kCapacity = 512;
  static constexpr double kSpacing_m = 0.04;
  /// A person who is seen again farther than this from the end of the trail begins a new one.
  static constexpr double kLongestGap_m = 3.0;

  struct Place {
    double x_m = 0.0;
    double y_m = 0.0;
    double heading_rad = 0.0;
    double curvature_1_m = 0.0;  ///< left bend +
  };

  void reset() { size_ = 0; }
  bool empty() const { return size_ == 0; }

  /// The person's body is seen at `body_m`, walking in the direction `travel_rad` (± sigma), from a robot at
  /// `robot`. Returns false when a new trail begins.
  bool add(const Eigen::Vector2d& body_m, double travel_rad, double travel_sigma_rad, const Pose2& robot);

  /// Arc lengths; that of the first point is zero. They stay valid until a new trail begins.
  double first_m() const { return point(0).s_m; }
  double last_m() const { return point(size_ - 1).s_m; }
  /// Of the person's newest place, along the trail's end.
  double tip_m() const { return last_m() + beyond_last_m_; }

  /// Smoothed over `half_width_m` on either side. After the last point the trail goes straight on.
  Place at(double s_m, double half_width_m) const;
  /// The arc length next to a place, found from `near_m` on, so that a trail that crosses itself is no
  /// problem.
  double nearest_m(double x_m, double y_m, double near_m, double half_width_m) const;

 private:
  struct Point {
    Eigen::Vector2d at_m = Eigen::Vector2d::Zero();
    double s_m = 0.0;
  };
  Point& point(std::size_t i) { return ring_[(begin_ + i) % kCapacity]; }
  const Point& point(std::size_t i) const { return ring_[(begin_ + i) % kCapacity]; }
  void start(const Eigen::Vector2d& body_m, const Pose2& robot);
  void extend(const Eigen::Vector2d& step_m);
  void push(const Eigen::Vector2d& at_m);
  void set_lead_in(double travel_rad, double travel_sigma_rad);
  Eigen::Vector2d end_direction() const;
  std::size_t first_at_or_after(double s_m) const;

  std::array<Point, kCapacity> ring_{};
  std::size_t begin_ = 0;
  std::size_t size_ = 0;
  double beyond_last_m_ = 0.0;
  Eigen::Vector2d first_seen_m_ = Eigen::Vector2d::Zero();
  double from_robot_rad_ = 0.0;  ///< direction from the robot to the first point, when the trail began
  Eigen::Vector2d lead_in_ = Eigen::Vector2d::UnitX();
};

}  // namespace heel
