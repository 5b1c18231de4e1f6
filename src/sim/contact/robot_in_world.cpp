#include "sim/contact/robot_in_world.h"

#include "heel/error.h"
#include "models/robot_models.h"

namespace heel::sim {

void apply_robot(const ScenarioRobot& robot, P3AtSettings& settings) {
  if (!robot.model.empty() && !index_of_model(robot.model))
    throw Error("robot.model: '" + robot.model + "' (expected " + robot_model_names() + ")");
  if (!robot.model.empty()) use_model(robot.model, settings);
  settings.start = {robot.x_m, robot.y_m, robot.heading_rad};
  settings.chassis.true_track_m = robot.true_track_m;
  settings.chassis.left_scale_error = robot.left_scale_error;
  settings.chassis.right_scale_error = robot.right_scale_error;
  settings.translation_top.acceleration = settings.translation_top.deceleration = robot.acceleration_top_m_s2;
  settings.chassis.wheel_deceleration_max_m_s2 = robot.brakes_m_s2;
  settings.sends_config = robot.sends_config;
  for (const std::string& fault : robot.faults) settings.faults.push_back(parse_fault(fault));
}

RobotMotion robot_motion_from_truth(const RobotTruth& truth) {
  return {truth.pose.x_m, truth.pose.y_m, truth.pose.heading_rad, truth.v_m_s, truth.yaw_rate_rad_s};
}

bool start_walk_when_motors_run(const RobotTruth& robot, double t_s, World& world) {
  if (world.walking() || !robot.motors_enabled) return false;
  world.start_walk(t_s + world.scenario().walk_after_s);
  return true;
}

void hold_walk_while_robot_is_far(const RobotTruth& robot, double t_s, double dt_s, World& world) {
  const double limit_m = world.scenario().waits_beyond_m;
  if (limit_m <= 0.0 || !world.walking()) return;
  const Eigen::Vector2d person_m = world.people_footprints(t_s).front().centre_m;
  const Eigen::Vector2d robot_m(robot.pose.x_m, robot.pose.y_m);
  world.hold_walk((person_m - robot_m).norm() > limit_m ? dt_s : 0.0);
}

}  // namespace heel::sim
