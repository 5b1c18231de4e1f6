// Columns of the robot's truth in CSV files, shared by runs in real time and in lock step.
#pragma once

#include <span>

#include "sim/robot/p3at.h"

namespace heel::sim {

struct RobotTruthColumn {
  const char* name;
  int decimals;
  double (*value)(const RobotTruth& truth);
};

/// robot_*: true pose and speed, world frame; odom_*: the pose as the firmware integrates it.
std::span<const RobotTruthColumn> robot_motion_columns();
/// Wheels, session, motors, watchdog, stalls, STOP button, bumpers and baud rate; flags are 0 or 1.
std::span<const RobotTruthColumn> robot_state_columns();

}  // namespace heel::sim
