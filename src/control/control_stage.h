// The control stage: from the newest pose and the robot's state to the velocity command, once a tick.
//   target in odom → conditions → supervisor's table → control law → gate → command
#pragma once

#include <memory>
#include <span>

#include "core/config.h"
#include "core/robot_model.h"
#include "heel/flow.h"

namespace heel {

/// Keeps the state of estimator, conditions and control law. Reads no clock and holds no device, so that the
/// daemon's control thread and the lock-step simulator run the same code.
class ControlStage {
 public:
  /// `models`: the table that RobotKind::model is a place in; it must outlive the stage. Until a robot has
  /// said what it is, the first one's shape is assumed. Throws heel::Error when `config.control.law` is not a
  /// control law.
  ControlStage(const Config& config, std::span<const RobotModel> models);
  ~ControlStage();
  ControlStage(ControlStage&&) noexcept;
  ControlStage& operator=(ControlStage&&) noexcept;

  /// New gains, limits and thresholds at a tick boundary; state is kept. The control law stays the one of the
  /// construction: another one would begin without the state that it needs while the robot drives. So does
  /// supervisor.start.
  void reconfigure(const Config& config);

  /// One tick: the input, and everything that was decided.
  TickRecord tick(const ControlInput& input);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace heel
