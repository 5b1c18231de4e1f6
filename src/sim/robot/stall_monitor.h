// The firmware's stall protection of one wheel: when the motor pushes for half a second and the wheel hardly
// moves, the motors are off for StallCount ms and then try again.
#pragma once

#include "heel/time.h"

namespace heel::sim {

class StallMonitor {
 public:
  explicit StallMonitor(TimeNs cut_ns) : cut_ns_(cut_ns) {}

  /// One step with power on or off; `target_m_s` and `actual_m_s` are the wheel's speeds.
  void step(bool powered, double target_m_s, double actual_m_s, TimeNs t_ns, TimeNs dt_ns);
  bool stalled(TimeNs t_ns) const { return t_ns < t_free_ns_; }

 private:
  TimeNs cut_ns_;
  TimeNs pushed_ns_ = 0;
  TimeNs t_free_ns_ = 0;
};

}  // namespace heel::sim
