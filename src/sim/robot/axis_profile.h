// The firmware's speed profile of one axis, translation (m) or rotation (rad): a ramp to a target speed, or a
// trapezoid that ends at a target distance.
#pragma once

namespace heel::sim {

struct AxisLimits {
  double speed = 0.0;         ///< per s, ≥ 0
  double acceleration = 0.0;  ///< per s², away from zero
  double deceleration = 0.0;  ///< per s², towards zero
};

class AxisProfile {
 public:
  /// One step of `dt_s` towards the speed `target`, limited to limits.speed. Before a change of sign it
  /// decelerates to zero.
  void step_to_speed(double target, const AxisLimits& limits, double dt_s);
  /// One step along the trapezoid that stops after the distance `remaining`; true when it has stopped there.
  bool step_to_distance(double remaining, const AxisLimits& limits, double dt_s);
  /// Sets the profile to the wheels' speed: after a stall, an emergency stop, motors off.
  void set_speed(double speed) { speed_ = speed; }
  double speed() const { return speed_; }

 private:
  double speed_ = 0.0;
};

}  // namespace heel::sim
