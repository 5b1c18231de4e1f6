// The walk of a person: place, heading and gait over time.
// World frame: x, y on the floor, z up; headings counter-clockwise from +x.
#pragma once

#include <cstdint>
#include <vector>

namespace heel::sim {

enum class WalkStep : std::uint8_t {
  Straight,
  Arc,
  To,
  Pause,
  Turn,
  Aside,  ///< sideways, without turning
  Back,   ///< backwards
  Sit,    ///< sit down on a stool behind the person, and stand up at the end
};

/// One step of a scenario's path. Only the fields of its kind are used.
struct WalkItem {
  WalkStep step = WalkStep::Straight;
  double speed_m_s = 0.5;  ///< Straight, Arc, To, Aside, Back
  double length_m = 0.0;   ///< Straight, Back; Aside: left is positive
  double radius_m = 0.6;   ///< Arc; To: the turn towards the waypoint
  double angle_rad = 0.0;  ///< Arc, Turn: left is positive
  double x_m = 0.0;        ///< To
  double y_m = 0.0;
  double duration_s = 0.0;  ///< Pause, Turn, Sit
};

struct WalkState {
  double x_m = 0.0;
  double y_m = 0.0;
  double heading_rad = 0.0;  ///< without jumps of 2π
  double speed_m_s = 0.0;    ///< ≥ 0
  double stride_rad = 0.0;   ///< phase of the gait: 2π is two steps; decreases when walking backwards
  double travel_rad = 0.0;  ///< direction of travel relative to the heading: 0 ahead, π/2 to the left, π back
  double seat = 0.0;        ///< 0 standing … 1 seated
};

/// The hips of a seated person are this far behind the feet, above the middle of the stool.
inline constexpr double kSeatBehindFeet_m = 0.40;
inline constexpr double kStoolSide_m = 0.36;
inline constexpr double kStoolHeight_m = 0.44;

/// The place of a stool's centre, and the heading of the person who sits on it.
struct StoolPlace {
  double x_m = 0.0;
  double y_m = 0.0;
  double heading_rad = 0.0;
};

/// Walks the items one after the other with limited acceleration, and brakes in time for the next one's
/// speed.
class Walk {
 public:
  /// Throws heel::Error when a waypoint lies inside its own turning circle.
  Walk(const WalkState& start, const std::vector<WalkItem>& items);

  /// The state `t_s` after the start of the walk; the first state before that, the last one after the end.
  WalkState at(double t_s) const;
  double duration_s() const;
  const std::vector<WalkState>& samples() const { return samples_; }
  /// One for each Sit item, in order.
  const std::vector<StoolPlace>& stools() const { return stools_; }

 private:
  struct Leg;
  static std::vector<Leg> legs_of(WalkState state, const std::vector<WalkItem>& items);
  static void legs_to(const WalkState& from, const WalkItem& item, std::vector<Leg>& legs);
  void move(const Leg& leg, double end_speed_m_s);
  void wait(const Leg& leg);

  std::vector<WalkState> samples_;
  std::vector<StoolPlace> stools_;
};

}  // namespace heel::sim
