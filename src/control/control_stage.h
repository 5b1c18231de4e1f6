// The control stage: everything between the newest pose and the wire, as pure functions of their inputs and
// `now`.
//   estimate (target in odom) → supervise (table) → law (the paper's) → gate (last look) → command
#pragma once

#include <memory>

#include "core/config.h"
#include "core/robot_geometry.h"
#include "heel/flow.h"

namespace heel {

/// Owns the estimator's and the supervisor's memory; reads no clock, holds no device. The daemon's control
/// thread and the lock-step simulator run the same code.
class ControlStage {
 public:
  /// Throws heel::Error when `config.control.law` is not a control law.
  ControlStage(const Config& config, const RobotGeometry& robot);
  ~ControlStage();
  ControlStage(ControlStage&&) noexcept;
  ControlStage& operator=(ControlStage&&) noexcept;

  /// New gains, limits and thresholds at a tick boundary; state is kept. The control law stays the one of the
  /// construction: another one would begin without the state that it needs while the robot drives.
  void reconfigure(const Config& config);

  /// One tick. The record holds the verdict, the target, the wanted and the gated command.
  TickRecord tick(const ControlInput& input);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace heel
