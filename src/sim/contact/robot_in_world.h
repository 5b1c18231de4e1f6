// The robot's model and the world's model of the same scenario, joined: settings, motion, and the start of
// the walk.
#pragma once

#include "sim/robot/p3at.h"
#include "sim/scene/world.h"

namespace heel::sim {

/// Adds what a scenario states about its robot: place, wheels, floor and faults. Throws heel::Error naming a
/// fault that cannot be read.
void apply_robot(const ScenarioRobot& robot, P3AtSettings& settings);

/// Pose and velocity of the simulated robot.
RobotMotion robot_motion_from_truth(const RobotTruth& truth);

/// Starts the person's walk `walk_after_s` after the first time this finds the robot's motors on; true that
/// time.
bool start_walk_when_motors_run(const RobotTruth& robot, double t_s, World& world);

/// Holds the walk for `dt_s` when the robot is farther from the person than the scenario's waits_beyond_m.
void hold_walk_while_robot_is_far(const RobotTruth& robot, double t_s, double dt_s, World& world);

}  // namespace heel::sim
