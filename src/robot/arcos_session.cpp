// The line and the packets of the session. The steps that are due at a time: arcos_session_steps.cpp;
// what the robot is: arcos_session_model.cpp; a line that echoes: arcos_session_echo.cpp.
#include "robot/arcos_session.h"

#include "arcos/command_codec.h"
#include "models/robot_models.h"
#include "robot/model_choice.h"
#include "robot/sip_to_state.h"

namespace heel {
namespace {

using arcos::CommandId;
using Kind = SessionEventKind;

}  // namespace

ArcosSession::ArcosSession(const RobotConfig& config)
    : config_(config),
      sweep_(parse_robot_address(config.address)),
      target_baud_(sweep_.current()),
      model_(&robot_models().front()),
      motion_(v_limit_mm_s(), yaw_rate_limit_deg_s()),
      odometry_(*model_) {
  pacer_.set_baud(sweep_.current());
}

bool ArcosSession::is_connected() const {
  switch (step_) {
    case Step::Opening:
    case Step::AskingRate:
    case Step::TryingRate:
    case Step::LeavingRate:
    case Step::Enabling:
    case Step::Running:
    case Step::Disabled:
      return true;
    default:
      return false;
  }
}

void ArcosSession::enter(Step step, TimeNs now_ns) {
  step_ = step;
  if (step != Step::Enabling) ends_e_stall_ = false;
  t_step_ns_ = now_ns;
  attempts_ = 0;
  switch (step) {
    case Step::NoLine:
      break;  // the caller sets the phase: Closed or Lost
    case Step::Listening:
    case Step::Sync0:
    case Step::Sync1:
    case Step::Sync2:
    case Step::Closing:
      return set_phase(LinkPhase::Syncing);
    case Step::Opening:
    case Step::AskingRate:
    case Step::TryingRate:
    case Step::LeavingRate:
      return set_phase(LinkPhase::Opening);
    case Step::Enabling:
      return set_phase(LinkPhase::Enabling);
    case Step::Running:
      return set_phase(LinkPhase::Running);
    case Step::Disabled:
      return set_phase(LinkPhase::Disabled);
    case Step::Silent:
      return set_phase(LinkPhase::Lost);
    case Step::Refused:
      return set_phase(LinkPhase::Refused);
  }
}

/// A robot that was refused stays so while it is asked again, and a line that another device answered stays
/// lost: a phase that changes each second is no news.
void ArcosSession::set_phase(LinkPhase phase) {
  const bool asks_again = phase == LinkPhase::Syncing;
  if (asks_again && is_refused(state_.kind.choice)) phase = LinkPhase::Refused;
  if (asks_again && (reported_echo_ || !reported_text_.text().empty())) phase = LinkPhase::Lost;
  state_.phase = phase;
}

void ArcosSession::line_opened(TimeNs now_ns) {
  parser_.reset();
  pacer_.reset();
  queue_.clear();
  sweep_.restart();
  pacer_.set_baud(sweep_.current());
  line_exhausted_ = false;
  heard_.clear();
  text_of_sweep_.clear();
  echo_heard_ = echo_of_sweep_ = false;
  bytes_of_sweep_ = 0;
  answered_ = false;
  if (!reported_echo_ && !repeats_.is_said()) events_.push(now_ns, Kind::LineOpened);
  enter(Step::Listening, now_ns);
}

void ArcosSession::line_lost(TimeNs now_ns) {
  if (step_ == Step::NoLine) return;
  queue_.clear();
  odometry_.interrupted();
  state_.kind = RobotKind{};
  // A server that has another client, or another service, says why it ends the connection.
  if (!is_connected() && !heard_.text().empty()) {
    report_other_device(heard_, now_ns);
  } else if (answered_) {
    events_.push(now_ns, Kind::LineLost);
  } else if (!line_exhausted_ && !reported_echo_) {  // of these, the cause has been said
    say_rarely(Kind::LineEnded, now_ns);
  }
  enter(Step::NoLine, now_ns);
  // A line on which no robot answered was not up, and cannot be lost.
  set_phase(answered_ ? LinkPhase::Lost : LinkPhase::Syncing);
}

/// Once for each text, and rarely where the texts change: a line that ends at once is opened again each
/// second.
void ArcosSession::report_other_device(const HeardText& heard, TimeNs now_ns) {
  if (heard.text() == reported_text_.text() || !repeats_.is_due(Kind::OtherDevice, now_ns)) return;
  reported_text_ = heard;
  events_.push(now_ns, Kind::OtherDevice);
}

/// A line without a robot is opened again every few seconds, for as long as the robot is off.
void ArcosSession::say_rarely(SessionEventKind trouble, TimeNs now_ns, std::int64_t value) {
  if (repeats_.is_due(trouble, now_ns)) events_.push(now_ns, trouble, value);
}

void ArcosSession::robot_answered() {
  sweep_.found();
  answered_ = true;
  repeats_.over();
}

std::span<const std::uint8_t> ArcosSession::close(TimeNs now_ns) {
  out_.clear();
  if (step_ != Step::NoLine) {
    if (state_.phase != LinkPhase::Refused) {  // that one was never opened, and may be anything
      out_.append(arcos::encode_plain(CommandId::Stop));
      out_.append(arcos::encode_integer(CommandId::Sonar, 0));
    }
    out_.append(arcos::encode_plain(CommandId::Close));
    events_.push(now_ns, Kind::Closed);
  }
  queue_.clear();
  odometry_.interrupted();
  enter(Step::NoLine, now_ns);
  set_phase(LinkPhase::Closed);
  return out_.bytes();
}

void ArcosSession::receive(std::span<const std::uint8_t> bytes, TimeNs t_ns) {
  if (step_ == Step::NoLine) return;
  if (!is_connected()) heard_.hear(bytes);
  parser_.feed(bytes, t_ns, [this](const arcos::Packet& packet) { on_packet(packet); });
  copy_line_counters();
}

void ArcosSession::copy_line_counters() {
  state_.checksum_errors = parser_.counters().checksum_errors + parser_.counters().length_errors;
  state_.bytes_discarded = parser_.counters().bytes_discarded;
}

void ArcosSession::on_packet(const arcos::Packet& packet) {
  const std::uint8_t id = packet.id();
  if (is_echo(packet)) return on_echo();
  if (step_ == Step::TryingRate) rate_confirmed(packet.t_first_byte_ns);
  if (arcos::is_sip(id)) {
    on_sip(packet);
  } else if (id == arcos::kConfigPacketId) {
    on_config(packet);
  } else if (arcos::is_reset_notice(id)) {
    on_reset_notice(packet.t_first_byte_ns);
  } else if (id <= static_cast<std::uint8_t>(CommandId::Sync2)) {
    on_sync_echo(id, packet);
  }
  // Other packets were not requested.
}

void ArcosSession::on_sync_echo(std::uint8_t number, const arcos::Packet& packet) {
  const TimeNs t_ns = packet.t_first_byte_ns;
  if (step_ == Step::Sync0 && number == 0) {
    ask_sync(Step::Sync1, t_ns);
  } else if (step_ == Step::Sync1 && number == 1) {
    ask_sync(Step::Sync2, t_ns);
  } else if (step_ == Step::Sync2 && number == 2) {
    if (may_be_echo_of_sync2(packet)) {
      bare_sync2_ = true;
      return;
    }
    if (decode_sync2_echo(packet.body, identity_) != arcos::DecodeResult::Ok) {
      events_.push(t_ns, Kind::BadPacket, number);
      identity_ = arcos::RobotIdentity{};  // the names are lost
    }
    robot_answered();
    reported_text_.clear();
    reported_echo_ = false;
    line_exhausted_ = false;
    on_identity(identity_, t_ns);
  }
}

void ArcosSession::on_sip(const arcos::Packet& packet) {
  const TimeNs t_ns = packet.t_first_byte_ns;
  if (arcos::decode_sip(packet.body, sip_) != arcos::DecodeResult::Ok) {
    events_.push(t_ns, Kind::BadPacket, packet.id());
    return;
  }
  if (!is_connected()) {
    if (step_ != Step::Closing) close_earlier_session(t_ns);
    return;
  }
  switch (odometry_.update(sip_, t_ns)) {
    case OdometryTracker::Step::Moved:
      break;
    case OdometryTracker::Step::Rebased:
      events_.push(t_ns, Kind::OdometryRebased);
      break;
    case OdometryTracker::Step::Suspect:
      events_.push(t_ns, Kind::OdometrySuspect);
      break;
  }
  state_.odometry = odometry_.pose();
  copy_status(sip_, state_);
  copy_sonar(sip_, *model_, t_ns, state_);
  ++state_.sips;
  t_sip_ns_ = t_ns;
  if (!sip_seen_) {
    sip_seen_ = true;
    if (was_connected_) ++state_.reconnects;
    was_connected_ = true;
    events_.push(t_ns, Kind::FirstSip);
  }
  apply_motor_flags(t_ns);
}

void ArcosSession::on_config(const arcos::Packet& packet) {
  if (step_ != Step::Opening || config_seen_) return;
  if (arcos::decode_config(packet.body, controller_) != arcos::DecodeResult::Ok) {
    controller_ = arcos::ConfigPacket{};
    events_.push(packet.t_first_byte_ns, Kind::BadPacket, packet.id());
    return;
  }
  config_seen_ = true;
  if (controller_.host_baud < kRobotBauds.size()) sweep_.set_power_on(kRobotBauds[controller_.host_baud]);
  // The TCP server's serial line to the robot has the robot's rate.
  if (!sweep_.sweeps() && controller_.host_baud < kRobotBauds.size())
    pacer_.set_baud(kRobotBauds[controller_.host_baud]);
  events_.push(packet.t_first_byte_ns, Kind::ConfigReceived, controller_.watchdog_ms);
}

void ArcosSession::on_reset_notice(TimeNs t_ns) {
  if (!is_connected()) return;
  events_.push(t_ns, Kind::ControllerReset);
  odometry_.controller_reset();
  queue_.clear();
  enter(Step::Listening, t_ns);
}

void ArcosSession::apply_motor_flags(TimeNs t_ns) {
  const bool held = state_.stop_button || (state_.e_stall && !ends_e_stall_);
  if (step_ == Step::Enabling) {
    if (held) {
      hold_disabled_ = true;
      queue_.clear();
      events_.push(t_ns, Kind::StopButton);
      enter(Step::Disabled, t_ns);
    } else if (state_.motors_enabled && !state_.e_stall && queue_.empty()) {
      // Not before zero velocity has been sent.
      events_.push(t_ns, Kind::MotorsEnabled);
      enter(Step::Running, t_ns);
    }
  } else if (step_ == Step::Running && (held || !state_.motors_enabled)) {
    hold_disabled_ = true;
    events_.push(t_ns, held ? Kind::StopButton : Kind::MotorsOff);
    enter(Step::Disabled, t_ns);
  }
}

void ArcosSession::close_earlier_session(TimeNs t_ns) {
  events_.push(t_ns, Kind::FoundOpen);
  robot_answered();  // a valid SIP: this is the robot's rate
  odometry_.interrupted();
  queue_.clear();
  queue_.push(arcos::encode_plain(CommandId::Stop));
  queue_.push(arcos::encode_plain(CommandId::Close));
  enter(Step::Closing, t_ns);
}

}  // namespace heel
