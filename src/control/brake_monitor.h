// How fast the robot really slows down, against what the gate plans with: its controller may allow less than
// was asked for without a word, and a slope or worn brakes take from it.
#pragma once

#include <limits>

#include "heel/flow.h"

namespace heel {

/// Measures the deceleration while the robot drives faster than it was told to. Reads no clock, does not
/// allocate.
class BrakeMonitor {
 public:
  /// Once a tick. `commanded`: the velocity that was sent in the tick before.
  void update(const RobotState& robot, const VelocityCommand& commanded);
  /// After an interruption, or an operator's reset: what was seen may no longer be true.
  void reset() { *this = {}; }

  /// The smallest deceleration of the drives so far in m/s²; infinite before the first. Below kLeast_m_s2 it
  /// is not believed.
  double seen_m_s2() const { return seen_m_s2_; }

  static constexpr double kLeast_m_s2 = 0.05;

 private:
  enum class Step : unsigned char { Obeys, IsTold, Slows };  ///< to slow down
  void start(Step step, double v_m_s);

  double seen_m_s2_ = std::numeric_limits<double>::infinity();
  TimeNs t_sip_ns_ = 0;
  double told_before_m_s_ = 0.0;  ///< the last command that the robot kept up with
  Step step_ = Step::Obeys;
  TimeNs t_start_ns_ = 0;  ///< of the step, or of the measurement
  double v_start_m_s_ = 0.0;
};

}  // namespace heel
