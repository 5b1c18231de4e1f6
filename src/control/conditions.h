// The conditions under which the robot must be at rest, as bits, with their hysteresis and hold times.
#pragma once

#include "core/config.h"
#include "core/robot_geometry.h"
#include "heel/flow.h"

namespace heel {

/// Finds the conditions that hold in a tick. A good frame is one that the estimator accepted with a certainty
/// of at least `certainty_follow`, or `certainty_drop` while following. Following starts after
/// `frames_to_follow` good frames in a row and ends when no good frame has come for `target_timeout_s`.
/// Motors that went off while the line was up stay off until an operator's reset.
class ConditionMonitor {
 public:
  /// Once a tick. `geometry`: of the robot, for its front sonars. `sonar_on`: without readings from these
  /// kSonarSilent holds. `command`: of a request that is new in this tick. `turns_away`: by TurnMonitor.
  Conditions update(const ControlInput& input, MeasurementStatus measurement, const SupervisorConfig& config,
                    const RobotGeometry& geometry, bool sonar_on, OperatorCommand command, bool turns_away);

 private:
  void update_following(const ControlInput& input, MeasurementStatus measurement,
                        const SupervisorConfig& config);
  bool motors_off(const RobotState& robot, OperatorCommand command);
  bool battery_low(const RobotState& robot, TimeNs now_ns, const SupervisorConfig& config);
  bool clock_stepped(const ControlInput& input);

  bool following_ = false;
  bool ever_followed_ = false;
  int good_frames_in_a_row_ = 0;
  TimeNs t_last_good_frame_ns_ = 0;
  bool ever_bumped_ = false;
  TimeNs t_last_bump_ns_ = 0;
  bool ever_stalled_ = false;
  TimeNs t_last_stall_ns_ = 0;
  bool motors_went_off_ = false;  // by the robot, and no reset since
  bool battery_low_ = false;
  TimeNs t_battery_fine_ns_ = 0;  // when it last had at least battery_low_v; 0: no voltage yet
  bool ticked_ = false;
  TimeNs t_last_tick_ns_ = 0;
};

}  // namespace heel
