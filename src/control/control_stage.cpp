// One control tick: estimate → supervise → law → gate.
#include "control/control_stage.h"

#include <cmath>
#include <limits>

#include "control/conditions.h"
#include "control/follow_law_factory.h"
#include "control/gate.h"
#include "control/sonar_obstacles.h"
#include "control/supervisor.h"
#include "estimate/target_estimator.h"

namespace heel {

struct ControlStage::Impl {
  Impl(const Config& config, const RobotGeometry& robot)
      : estimator(config), obstacle_map(robot), law(make_follow_law(config)) {
    reconfigure(config);
  }

  void reconfigure(const Config& config);

  void update_robot(const RobotState& robot);
  MeasurementStatus update_target(const ControlInput& input);
  double person_range_m(const TargetState& target) const;
  VelocityCommand wanted(const FollowInput& input) const;

  // Only the parts in use, none of which holds text: taking over a configuration takes no memory.
  SupervisorConfig supervisor;
  GateConfig gate;
  CameraMount mount;
  bool sonar_on = true;

  TargetEstimator estimator;
  SonarObstacleMap obstacle_map;
  std::unique_ptr<FollowLaw> law;
  ConditionMonitor monitor;
  VelocityCommand last_command;
  std::uint64_t ticks = 0;
  std::uint64_t reconnects = 0;
  bool any_frame = false;
  std::uint64_t last_frame = 0;
  TimeNs t_last_frame_ns = 0;
};

void ControlStage::Impl::reconfigure(const Config& config) {
  supervisor = config.supervisor;
  gate = config.gate;
  mount = mount_of(config.camera);
  sonar_on = config.robot.sonar;
  estimator.reconfigure(config);
  law->reconfigure(config);
}

/// After a reconnection odom begins anew, and with it everything expressed in it.
void ControlStage::Impl::update_robot(const RobotState& robot) {
  if (robot.reconnects != reconnects) {
    reconnects = robot.reconnects;
    estimator.reset();
    obstacle_map.clear();
    law->reset();
  }
  if (!robot.has_sip) return;
  estimator.add_odometry(robot.odometry);
  if (sonar_on) obstacle_map.update(robot);
}

MeasurementStatus ControlStage::Impl::update_target(const ControlInput& input) {
  // By number and time: a film that begins again, or a single picture, counts from the same number anew.
  const bool seen =
      any_frame && input.pose.frame_sequence == last_frame && input.pose.t_capture_ns == t_last_frame_ns;
  if (!input.has_pose || seen) return MeasurementStatus::None;
  any_frame = true;
  last_frame = input.pose.frame_sequence;
  t_last_frame_ns = input.pose.t_capture_ns;
  return estimator.update(input.pose) ? MeasurementStatus::Accepted : MeasurementStatus::Rejected;
}

/// Camera to back, when the person is ahead; nobody there is infinitely far.
double ControlStage::Impl::person_range_m(const TargetState& target) const {
  const double x_m = target.x_m - mount.x_m;
  const double y_m = target.y_m - mount.y_m;
  if (!target.known || x_m <= 0.0) return std::numeric_limits<double>::infinity();
  return std::hypot(x_m, y_m);
}

/// What the law wants, as a command that expires.
VelocityCommand ControlStage::Impl::wanted(const FollowInput& input) const {
  const WantedVelocity velocity = law->velocity(input);
  VelocityCommand command;
  command.t_issued_ns = input.now_ns;
  command.t_expires_ns = input.now_ns + ns_from_seconds(gate.command_lifetime_s);
  command.v_m_s = velocity.v_m_s;
  command.yaw_rate_rad_s = velocity.yaw_rate_rad_s;
  return command;
}

ControlStage::ControlStage(const Config& config, const RobotGeometry& robot)
    : impl_(std::make_unique<Impl>(config, robot)) {}
ControlStage::~ControlStage() = default;
ControlStage::ControlStage(ControlStage&&) noexcept = default;
ControlStage& ControlStage::operator=(ControlStage&&) noexcept = default;

void ControlStage::reconfigure(const Config& config) {
  impl_->reconfigure(config);
}

TickRecord ControlStage::tick(const ControlInput& input) {
  Impl& s = *impl_;
  TickRecord record;
  record.tick = s.ticks++;
  record.input = input;

  s.update_robot(input.robot);
  record.measurement = s.update_target(input);
  record.target = s.estimator.at(input.now_ns);
  record.conditions = s.monitor.observe(input, record.measurement, s.supervisor, s.sonar_on);
  const Verdict verdict = supervise(record.conditions);
  record.stop_reason = verdict.reason;
  const Clearances clearances{s.person_range_m(record.target),
                              s.obstacle_map.obstacles_at(input.now_ns, input.robot.odometry)};
  record.wanted = s.wanted({input.now_ns, record.target, input.robot, clearances.obstacles});
  const GateResult gated =
      apply_gate(record.wanted, s.last_command, verdict.style, clearances, input.now_ns, s.gate);
  record.free_distance_m = gated.free_distance_m;
  record.command = gated.command;
  s.last_command = record.command;
  return record;
}

}  // namespace heel
