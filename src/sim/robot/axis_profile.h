// The firmware's speed profile on one axis, translation (m) or rotation (rad): a trapezoid towards a wanted
// speed, or to rest at a wanted distance.
#pragma once

namespace heel::sim {

struct AxisLimits {
  double speed = 0.0;         ///< per s, ≥ 0
  double acceleration = 0.0;  ///< per s², away from zero
  double deceleration = 0.0;  ///< per s², towards zero
};

class AxisProfile {
 public:
  /// One step of `dt_s` towards `wanted` speed, clamped to the limit. A change of sign decelerates to zero
  /// first.
  void step_to_speed(double wanted, const AxisLimits& limits, double dt_s);
  /// One step along the trapezoid that comes to rest after `remaining` more distance; true when it rests
  /// there.
  bool step_to_distance(double remaining, const AxisLimits& limits, double dt_s);
  /// The profile is where the wheels are: after a stall, an emergency stop, motors off.
  void set_speed(double speed) { speed_ = speed; }
  double speed() const { return speed_; }

 private:
  double speed_ = 0.0;
};

}  // namespace heel::sim
