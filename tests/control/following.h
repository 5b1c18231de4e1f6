// The control stage in a loop with an exact robot and a perfect camera.
#pragma once

#include <string>

#include "control/control_stage.h"
#include "estimate/floor_truth.h"
#include "models/robot_models.h"

namespace heel::test {

/// `person` on the other side of the line along which `robot` heads: as a camera sees them whose picture is
/// mirrored.
inline Pose2 mirrored_ahead_of(const Pose2& robot, const Pose2& person) {
  Eigen::Vector2d there = in_robot(robot, person.x_m, person.y_m);
  there.y() = -there.y();
  const Eigen::Vector2d seen = Eigen::Rotation2Dd(robot.heading_rad) * there;
  return {robot.x_m + seen.x(), robot.y_m + seen.y(), 2.0 * robot.heading_rad - person.heading_rad};
}

struct Following {
  Config config;
  ControlStage stage{config, robot_models()};
  Reference reference;
  Pose2 robot;
  Pose2 person{3.0, 0.0, 0.0};
  double person_v_m_s = 0.5, person_yaw_rate_rad_s = 0.0;
  bool camera = true, visible = true;
  bool packets = true, sonars = true, operator_there = true;
  bool mirrored = false;  // the picture
  PoseReason reason = PoseReason::Found;
  double certainty = 0.4;
  double ahead_m = 0.0;  // range of the front sonar just left of the middle; 0: free
  ControlInput input;
  TickRecord record;
  double v_m_s = 0.0, yaw_rate_rad_s = 0.0;

  /// Without an operator, unless `start` asks for one.
  explicit Following(const std::string& law = "view", const std::string& start = "at_once")
      : config(config_with(law, start)) {
    input.now_ns = 5 * kNsPerS;
    input.robot.phase = LinkPhase::Running;
    input.robot.has_sip = true;
    input.robot.motors_enabled = true;
    input.robot.limits = {.known = true, .acceleration_m_s2 = 0.6, .deceleration_m_s2 = 1.5};
    input.robot.odometry = odometry(input.now_ns, robot, 0, 0);
  }

  static Config config_with(const std::string& law, const std::string& start) {
    Config config;
    config.control.law = law;
    config.supervisor.start = start;
    return config;
  }

  void request(OperatorCommand command) { input.request = {input.request.number + 1, input.now_ns, command}; }
  void tick() {
    if (operator_there) input.t_operator_ns = input.now_ns;
    if (packets && input.now_ns % (100 * kNsPerMs) == 0) {
      input.robot.odometry = odometry(input.now_ns, robot, v_m_s, yaw_rate_rad_s);
      if (sonars) input.robot.sonar.fill({input.now_ns, 5.0});
      if (ahead_m > 0.0) input.robot.sonar[3].range_m = ahead_m;
    }
    if (camera && input.now_ns % (40 * kNsPerMs) == 0) {
      const std::uint64_t sequence = input.pose.frame_sequence + 1;
      const Pose2 seen = mirrored ? mirrored_ahead_of(robot, person) : person;
      input.pose = measured(seen, robot, mount_of(config.camera), reference);
      input.pose.certainty = certainty;
      input.pose.reason = visible ? reason : PoseReason::TooFewMatches;
      input.pose.frame_sequence = sequence;
      input.pose.t_capture_ns = input.now_ns;
      input.has_pose = true;
    }
    record = stage.tick(input);
    v_m_s = record.command.v_m_s;
    yaw_rate_rad_s = record.command.yaw_rate_rad_s;
    robot = moved(robot, v_m_s, yaw_rate_rad_s, 0.02);
    person = moved(person, person_v_m_s, person_yaw_rate_rad_s, 0.02);
    input.now_ns += 20 * kNsPerMs;
  }
  void run(double seconds) {
    for (TimeNs end_ns = input.now_ns + ns_from_seconds(seconds); input.now_ns < end_ns;) tick();
  }
  /// From the largest speed to rest.
  double braking_s() const { return config.gate.v_max_m_s / config.gate.deceleration_m_s2; }
  /// Seconds until the command is zero.
  double until_rest() {
    const TimeNs start_ns = input.now_ns;
    while (v_m_s != 0.0 || yaw_rate_rad_s != 0.0) tick();
    return seconds_from_ns(input.now_ns - start_ns);
  }
};

}  // namespace heel::test
