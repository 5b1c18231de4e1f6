#include "sim/robot/stall_monitor.h"

#include <cmath>

namespace heel::sim {
namespace {

constexpr TimeNs kPush_ns = 500 * kNsPerMs;
constexpr double kStanding_m_s = 0.1;
constexpr double kPushing_m_s = 0.02;  // speed error at which the controller raises the PWM

}  // namespace

void StallMonitor::step(bool powered, double target_m_s, double actual_m_s, TimeNs t_ns, TimeNs dt_ns) {
  const bool is_pushing =
      powered && std::abs(actual_m_s) < kStanding_m_s && std::abs(target_m_s - actual_m_s) > kPushing_m_s;
  pushed_ns_ = is_pushing ? pushed_ns_ + dt_ns : 0;
  if (pushed_ns_ < kPush_ns) return;
  pushed_ns_ = 0;
  t_free_ns_ = t_ns + cut_ns_;
}

}  // namespace heel::sim
