// What may keep the robot at rest, as bits, and the little memory they need: hysteresis and hold times.
#pragma once

#include "core/config.h"
#include "heel/flow.h"

namespace heel {

/// Turns inputs into conditions. Following starts after `frames_to_follow` believed frames in a row at
/// `certainty_follow`, goes on while believed frames at `certainty_drop` come, and ends when none has come
/// for `target_timeout_s`.
class ConditionMonitor {
 public:
  /// `sonar_on`: whether their silence is a fault.
  Conditions observe(const ControlInput& input, MeasurementStatus news, const SupervisorConfig& config,
                     bool sonar_on);

 private:
  void observe_target(const ControlInput& input, MeasurementStatus news, const SupervisorConfig& config);

  bool following_ = false;
  bool ever_followed_ = false;
  int good_in_a_row_ = 0;
  TimeNs t_last_good_ns_ = 0;
  bool bumped_ = false;  // ever: the hold time counts from the last touch
  TimeNs t_last_bump_ns_ = 0;
  bool stalled_ = false;
  TimeNs t_last_stall_ns_ = 0;
};

}  // namespace heel
