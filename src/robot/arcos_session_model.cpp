// What the robot says that it is decides whether the session opens it, and in which units it speaks.
#include "arcos/command_codec.h"
#include "models/robot_models.h"
#include "robot/arcos_session.h"
#include "robot/model_choice.h"

namespace heel {
namespace {

using arcos::CommandId;
using Kind = SessionEventKind;

}  // namespace

void ArcosSession::on_identity(const arcos::RobotIdentity& identity, TimeNs t_ns) {
  const RobotKind before = state_.kind;
  state_.kind = choose_model(identity, config_.model);
  if (!is_refused(state_.kind.choice)) {
    use_model(robot_models()[state_.kind.model]);
    events_.push(t_ns, Kind::Synchronised);
    return open_robot(t_ns);
  }
  const bool said = before.choice == state_.kind.choice && before.subclass == state_.kind.subclass &&
                    before.robot_class == state_.kind.robot_class;
  if (!said)
    events_.push(t_ns, state_.kind.choice == ModelChoice::Unknown    ? Kind::ModelUnknown
                       : state_.kind.choice == ModelChoice::Conflict ? Kind::ModelConflict
                                                                     : Kind::ModelMissing);
  queue_.clear();
  queue_.push(arcos::encode_integer(CommandId::Close, 1));
  enter(Step::Refused, t_ns);
}

void ArcosSession::use_model(const RobotModel& model) {
  if (&model == model_) return;
  model_ = &model;
  motion_ = MotionSender(v_limit_mm_s(), yaw_rate_limit_deg_s());
  odometry_.use(model);
  state_.sonar = {};  // the numbers mean other places
}

void ArcosSession::open_robot(TimeNs t_ns) {
  sip_seen_ = config_seen_ = false;
  controller_ = arcos::ConfigPacket{};
  queue_.clear();
  queue_.push(arcos::encode_integer(CommandId::Open, 1));
  queue_.push(arcos::encode_plain(CommandId::Stop));
  if (config_.request_config) queue_.push(arcos::encode_integer(CommandId::Config, 1));
  enter(Step::Opening, t_ns);
}

}  // namespace heel
