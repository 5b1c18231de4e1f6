// The firmware's stall protection for one wheel: pushing for half a second while the wheel all but stands
// cuts the motors' power for StallCount ms; then they try again.
#pragma once

#include "heel/time.h"

namespace heel::sim {

class StallMonitor {
 public:
  explicit StallMonitor(TimeNs cut_ns) : cut_ns_(cut_ns) {}

  /// One step with power on or off. `wanted` and `actual` are the wheel's speeds.
  void step(bool powered, double wanted_m_s, double actual_m_s, TimeNs t_ns, TimeNs dt_ns);
  bool stalled(TimeNs t_ns) const { return t_ns < t_free_ns_; }

 private:
  TimeNs cut_ns_;
  TimeNs pushed_ns_ = 0;
  TimeNs t_free_ns_ = 0;
};

}  // namespace heel::sim
