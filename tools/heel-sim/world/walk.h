// The path a person walks, as a table over time, and the gait that goes with it.
// World frame: x, y on the floor, z up; headings counter-clockwise from +x.
#pragma once

#include <cstdint>
#include <vector>

namespace heel::sim {

enum class WalkStep : std::uint8_t { Straight, Arc, To, Pause, Turn };

/// One entry of a scenario's path. Only the fields of its kind are used.
struct WalkItem {
  WalkStep step = WalkStep::Straight;
  double speed_m_s = 0.5;  ///< Straight, Arc, To
  double length_m = 0.0;   ///< Straight
  double radius_m = 0.6;   ///< Arc; To: the turn towards the waypoint
  double angle_rad = 0.0;  ///< Arc, Turn: left is positive
  double x_m = 0.0;        ///< To
  double y_m = 0.0;
  double duration_s = 0.0;  ///< Pause, Turn
};

struct WalkState {
  double x_m = 0.0;
  double y_m = 0.0;
  double heading_rad = 0.0;  ///< continuous
  double speed_m_s = 0.0;
  double stride_rad = 0.0;  ///< gait phase: 2π is two steps
};

/// Walks the items one after the other with bounded acceleration, braking in time for the next one's speed.
class Walk {
 public:
  /// Throws heel::Error when a waypoint lies inside its own turning circle.
  Walk(const WalkState& start, const std::vector<WalkItem>& items);

  /// The state `t_s` after the walk began; before that the start, after the end the last.
  WalkState at(double t_s) const;
  double duration_s() const;
  const std::vector<WalkState>& samples() const { return samples_; }

 private:
  void move(double length_m, double curvature_1_m, double speed_m_s, double end_speed_m_s);
  void wait(double duration_s, double turn_rad);

  std::vector<WalkState> samples_;
};

}  // namespace heel::sim
