#include "control/brake_monitor.h"

#include <algorithm>
#include <cmath>

namespace heel {
namespace {

constexpr double kTooFast_m_s = 0.06;  // a robot that follows a ramp of commands is late by less
// Commands take up to this time to act and to show: one SIP cycle each, and the line.
constexpr TimeNs kDelay_ns = 200 * kNsPerMs;
constexpr TimeNs kMeasured_ns = 200 * kNsPerMs;

}  // namespace

void BrakeMonitor::update(const RobotState& robot, const VelocityCommand& commanded) {
  if (!robot.has_sip || robot.odometry.t_ns == t_sip_ns_) return;
  t_sip_ns_ = robot.odometry.t_ns;
  const double direction = std::copysign(1.0, robot.odometry.v_m_s);
  const double v_m_s = std::abs(robot.odometry.v_m_s);
  const bool too_fast = v_m_s - std::max(direction * commanded.v_m_s, 0.0) > kTooFast_m_s;
  if (!too_fast || !robot.motors_enabled) {
    slowing_ = measuring_ = false;
    return;
  }
  if (!slowing_) t_slowing_ns_ = t_sip_ns_;
  slowing_ = true;
  if (t_sip_ns_ - t_slowing_ns_ < kDelay_ns) return;
  if (!measuring_) {
    measuring_ = true;
    t_start_ns_ = t_sip_ns_;
    v_start_m_s_ = v_m_s;
    return;
  }
  const TimeNs measured_ns = t_sip_ns_ - t_start_ns_;
  if (measured_ns < kMeasured_ns) return;
  const double deceleration_m_s2 = (v_start_m_s_ - v_m_s) / seconds_from_ns(measured_ns);
  seen_m_s2_ = std::min(seen_m_s2_, std::max(deceleration_m_s2, kLeast_m_s2));
  measuring_ = false;  // the next SIP starts another one
}

}  // namespace heel
