#include "control/control_stage.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "control/brake_monitor.h"
#include "control/comfort_limiter.h"
#include "control/conditions.h"
#include "control/follow_law_factory.h"
#include "control/gate.h"
#include "control/sonar_obstacles.h"
#include "control/supervisor.h"
#include "control/turn_monitor.h"
#include "estimate/target_estimator.h"

namespace heel {
namespace {

constexpr double kAsPromised = 0.8;  // of the deceleration: less is not the noise of a measurement

void copy_verdict(const Verdict& verdict, TickRecord& record) {
  record.state = verdict.state;
  record.cause = verdict.cause;
  record.t_transition_ns = verdict.t_transition_ns;
  record.stop_reason = verdict.stop_reason;
  record.request_number = verdict.request_number;
  record.outcome = verdict.outcome;
  record.refused_by = verdict.refused_by;
  record.needs_start = verdict.needs_start;
  record.enable_motors = verdict.enable_motors;
}

}  // namespace

struct ControlStage::Impl {
  Impl(const Config& config, std::span<const RobotModel> table)
      : pictures_answer(!config.camera.from_file()),
        models(table),
        estimator(config),
        obstacle_map(table.front().geometry),
        law(make_follow_law(config)),
        supervisor(config.supervisor) {
    reconfigure(config);
  }

  void reconfigure(const Config& config);

  void use_model(const RobotKind& kind);
  void update_robot(const RobotState& robot);
  MeasurementStatus update_target(const ControlInput& input);
  double person_range_m(const TargetState& target) const;
  bool brakes_are_weaker(const RobotState& robot) const {
    return brake_monitor.seen_m_s2() < kAsPromised * robot.limits.deceleration_m_s2;
  }
  double brakes_m_s2(const RobotState& robot) const;
  VelocityCommand wanted(const FollowInput& input);

  // The parts of the configuration in use. They hold no text that is longer than a std::string keeps in
  // itself, so that reconfigure() does not allocate.
  SupervisorConfig supervisor_config;
  GateConfig gate_config;
  CameraMount mount;
  bool sonar_on = true;
  const bool pictures_answer;  // the robot's turning: recorded ones do not

  std::span<const RobotModel> models;
  std::size_t model = 0;

  TargetEstimator estimator;
  SonarObstacleMap obstacle_map;
  BrakeMonitor brake_monitor;
  TurnMonitor turn_monitor;
  std::unique_ptr<FollowLaw> law;
  ComfortLimiter comfort;
  ConditionMonitor condition_monitor;
  Supervisor supervisor;
  bool search_done = false;  // the last tick's search has come to its end
  VelocityCommand last_command;
  std::uint64_t ticks = 0;
  std::uint64_t configuration = 0;
  std::uint64_t reconnects = 0;
  bool any_pose = false;
  std::uint64_t last_frame_sequence = 0;
  TimeNs t_last_capture_ns = 0;
};

void ControlStage::Impl::reconfigure(const Config& config) {
  supervisor_config = config.supervisor;
  gate_config = config.gate;
  mount = mount_of(config.camera);
  sonar_on = config.robot.sonar;
  estimator.reconfigure(config);
  law->reconfigure(config);
  comfort.reconfigure(config);
}

/// The robot that answers has its own outline and sonars.
void ControlStage::Impl::use_model(const RobotKind& kind) {
  if (kind.choice != ModelChoice::Chosen || kind.model == model || kind.model >= models.size()) return;
  model = kind.model;
  obstacle_map.use(models[model].geometry);
}

/// During an interruption the robot may have moved: after it, what was kept in odom no longer holds.
void ControlStage::Impl::update_robot(const RobotState& robot) {
  if (robot.reconnects != reconnects) {
    reconnects = robot.reconnects;
    estimator.reset();
    obstacle_map.clear();
    brake_monitor.reset();
    turn_monitor.reset();
    law->reset();
  }
  if (!robot.has_sip) return;
  estimator.add_odometry(robot.odometry);
  if (sonar_on) obstacle_map.update(robot);
  brake_monitor.update(robot, last_command);
  turn_monitor.update(estimator.odometry(), robot.odometry.t_ns);
}

MeasurementStatus ControlStage::Impl::update_target(const ControlInput& input) {
  // Number and time: a video that is played again repeats its frame numbers.
  const bool same_as_before = any_pose && input.pose.frame_sequence == last_frame_sequence &&
                              input.pose.t_capture_ns == t_last_capture_ns;
  if (!input.has_pose || same_as_before) return MeasurementStatus::None;
  any_pose = true;
  last_frame_sequence = input.pose.frame_sequence;
  t_last_capture_ns = input.pose.t_capture_ns;
  if (pictures_answer) turn_monitor.add_pose(input.pose, mount);
  return estimator.update(input.pose);
}

/// Camera to back when the person is ahead of the camera, otherwise infinite.
double ControlStage::Impl::person_range_m(const TargetState& target) const {
  const double x_m = target.x_m - mount.x_m;
  const double y_m = target.y_m - mount.y_m;
  if (!target.known || x_m <= 0.0) return std::numeric_limits<double>::infinity();
  return std::hypot(x_m, y_m);
}

/// The deceleration that a stop can be planned with: what the controller allows, or less if it was seen.
double ControlStage::Impl::brakes_m_s2(const RobotState& robot) const {
  return brakes_are_weaker(robot) ? brake_monitor.seen_m_s2() : robot.limits.deceleration_m_s2;
}

/// What the law wants within the limits of comfort, as a command that expires.
VelocityCommand ControlStage::Impl::wanted(const FollowInput& input) {
  const WantedVelocity wanted = law->velocity(input);
  search_done = input.searching && wanted.search_done;
  const WantedVelocity velocity = comfort.limited(wanted, last_command, input.now_ns);
  VelocityCommand command;
  command.t_issued_ns = input.now_ns;
  command.t_expires_ns = input.now_ns + ns_from_seconds(gate_config.command_lifetime_s);
  command.v_m_s = velocity.v_m_s;
  command.yaw_rate_rad_s = velocity.yaw_rate_rad_s;
  return command;
}

ControlStage::ControlStage(const Config& config, std::span<const RobotModel> models)
    : impl_(std::make_unique<Impl>(config, models)) {}
ControlStage::~ControlStage() = default;
ControlStage::ControlStage(ControlStage&&) noexcept = default;
ControlStage& ControlStage::operator=(ControlStage&&) noexcept = default;

void ControlStage::reconfigure(const Config& config) {
  impl_->reconfigure(config);
  ++impl_->configuration;
}

TickRecord ControlStage::tick(const ControlInput& input) {
  Impl& impl = *impl_;
  TickRecord record;
  record.tick = impl.ticks++;
  record.configuration = impl.configuration;
  record.input = input;

  impl.use_model(input.robot.kind);
  impl.update_robot(input.robot);
  record.measurement = impl.update_target(input);
  record.target = impl.estimator.predict(input.now_ns);
  const OperatorCommand command = impl.supervisor.new_command(input.request);
  if (command == OperatorCommand::Reset) impl.turn_monitor.reset();
  record.conditions = impl.condition_monitor.update(input, record.measurement, impl.supervisor_config,
                                                    impl.models[impl.model].geometry, impl.sonar_on, command,
                                                    impl.turn_monitor.turns_away());
  const bool may_search = impl.law->may_search() && !impl.search_done;
  const Verdict verdict =
      impl.supervisor.update(input, record.conditions, may_search, impl.supervisor_config);
  copy_verdict(verdict, record);
  if (verdict.enable_motors) impl.brake_monitor.reset();
  record.person_m = impl.person_range_m(record.target);
  Clearances clearances{record.person_m, impl.obstacle_map.obstacles_at(input.now_ns, input.robot.odometry),
                        impl.brakes_m_s2(input.robot)};
  if (record.target.known) clearances.obstacles.expect_person({record.target.x_m, record.target.y_m});
  record.planned_deceleration_m_s2 =
      std::min(clearances.deceleration_m_s2, impl.gate_config.deceleration_m_s2);
  record.brakes_are_weaker = impl.brakes_are_weaker(input.robot);
  record.wanted = impl.wanted({input.now_ns, record.target, input.robot, clearances.obstacles,
                               verdict.state == SupervisorState::Searching});
  const GateResult gated =
      apply_gate(record.wanted, impl.last_command, verdict.style, clearances, input.now_ns, impl.gate_config);
  record.free_distance_m = gated.free_distance_m;
  record.hold = gated.hold;
  record.command = gated.command;
  impl.last_command = record.command;
  return record;
}

}  // namespace heel
