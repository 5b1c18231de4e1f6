#include "control/brake_monitor.h"

#include <algorithm>
#include <cmath>

namespace heel {
namespace {

constexpr double kTooFast_m_s = 0.06;  // a robot that follows a ramp of commands is late by less
constexpr double kTold_m_s = 0.15;     // the command fell by at least that: no slope, no push by hand
constexpr double kFalls_m_s = 0.03;    // the robot has begun to slow down
constexpr TimeNs kObeys_ns = kNsPerS;  // a robot that has not begun after this time does not slow down
constexpr TimeNs kMeasured_ns = 200 * kNsPerMs;

}  // namespace

void BrakeMonitor::update(const RobotState& robot, const VelocityCommand& commanded) {
  if (!robot.has_sip || robot.odometry.t_ns == t_sip_ns_) return;
  t_sip_ns_ = robot.odometry.t_ns;
  const double v_m_s = std::abs(robot.odometry.v_m_s);
  const double told_m_s = std::max(std::copysign(1.0, robot.odometry.v_m_s) * commanded.v_m_s, 0.0);
  if (v_m_s - told_m_s <= kTooFast_m_s || !robot.motors_enabled) {
    step_ = Step::Obeys;
    told_before_m_s_ = told_m_s;
    return;
  }
  if (told_before_m_s_ - told_m_s < kTold_m_s) return;
  switch (step_) {
    case Step::Obeys:
      start(Step::IsTold, v_m_s);
      return;
    case Step::IsTold:
      // Until it begins to slow down, only the delays of the line pass.
      if (v_m_s < v_start_m_s_ - kFalls_m_s || t_sip_ns_ - t_start_ns_ > kObeys_ns) start(Step::Slows, v_m_s);
      return;
    case Step::Slows:
      break;
  }
  const TimeNs measured_ns = t_sip_ns_ - t_start_ns_;
  if (measured_ns < kMeasured_ns) return;
  seen_m_s2_ = std::max((v_start_m_s_ - v_m_s) / seconds_from_ns(measured_ns), kLeast_m_s2);
  start(Step::Slows, v_m_s);
}

void BrakeMonitor::start(Step step, double v_m_s) {
  step_ = step;
  t_start_ns_ = t_sip_ns_;
  v_start_m_s_ = v_m_s;
}

}  // namespace heel
