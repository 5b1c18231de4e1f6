// Comfort: limits of acceleration and jerk for the output of every control law, before the gate. It brings
// the velocity to the wanted one in the shortest time that the limits allow, without overshoot, but
// for a fraction of one step, for a wanted velocity that stays. It is no safety limit: the gate behind it
// brakes as hard as it must, and the limiter goes on from what the gate let through.
#pragma once

#include "control/follow_law.h"
#include "core/config.h"
#include "heel/flow.h"

namespace heel {

class ComfortLimiter {
 public:
  /// A limit of the gate that is tighter counts: a limiter that goes beyond it would begin again each tick.
  void reconfigure(const Config& config);

  /// `previous` is the last command that was sent, which the velocity goes on from; one that has expired
  /// counts as rest. A wanted velocity that is not finite is passed on: the gate refuses it.
  WantedVelocity limited(const WantedVelocity& wanted, const VelocityCommand& previous, TimeNs now_ns);

 private:
  struct Limits {
    double speed_up = 0.0;   // per s², away from zero
    double slow_down = 0.0;  // per s², towards zero
    double jerk = 0.0;       // per s³
  };
  struct Axis {
    Limits limits;
    double velocity = 0.0;  // of the last step
    double acceleration = 0.0;
    double step(double wanted, double from, double dt_s);
  };
  Axis translation_;
  Axis rotation_;
};

}  // namespace heel
