// The states of the P3-AT's connection, and the effect of packets on them.
#include <string_view>

#include "arcos/other_packets.h"
#include "sim/robot/p3at.h"

namespace heel::sim {
namespace {

using arcos::CommandId;

constexpr std::string_view kBootJunk = "WMS2\r";

}  // namespace

void P3At::on_packet(const arcos::Packet& packet) {
  arcos::Command command;
  if (arcos::decode_command(packet.body, command) != arcos::DecodeResult::Ok) return;
  switch (session_) {
    case Session::Waiting:
    case Session::Synced0:
    case Session::Synced1:
      sync(command);
      break;
    case Session::Connected:
    case Session::Open:
      execute(command);
      break;
    case Session::Maintenance:
      break;
  }
}

void P3At::sync(const arcos::Command& command) {
  if (command.type != arcos::ArgumentType::None) return;  // an OPEN or CLOSE at the wrong time
  const bool expected = (command.id == 0) || (command.id == 1 && session_ != Session::Waiting) ||
                        (command.id == 2 && session_ == Session::Synced1);
  if (!expected) return;
  if (junk_pending_) {
    line_.from_robot({reinterpret_cast<const std::uint8_t*>(kBootJunk.data()), kBootJunk.size()}, t_ns_);
    junk_pending_ = false;
  }
  if (command.id == 2) {
    session_ = Session::Connected;
    send(arcos::encode_sync2_echo(
        {arcos::Text(settings_.name), arcos::Text(settings_.type), arcos::Text(settings_.subtype)}));
    log(RobotEventKind::Synced);
    return;
  }
  session_ = command.id == 0 ? Session::Synced0 : Session::Synced1;
  const std::uint8_t echo[] = {command.id};
  send(arcos::frame_body(echo));
}

void P3At::open() {
  session_ = Session::Open;
  t_last_command_ns_ = t_ns_;
  t_next_sip_ns_ = t_ns_ + settings_.sip_cycle_ns;
  sonar_.enable_all(true);
  sonar_.take_readings();
  log(RobotEventKind::Opened);
}

void P3At::close() {
  forget_session();
  log(RobotEventKind::Closed);
  if (settings_.keeps_rate_after_close || line_.robot_baud() == settings_.boot_baud) return;
  line_.set_robot_baud(settings_.boot_baud);
  log(RobotEventKind::BaudChanged, settings_.boot_baud);
}

void P3At::forget_session() {
  session_ = Session::Waiting;
  motors_enabled_ = false;
  watchdog_stopped_ = false;
  drive_.stop();
  sonar_.enable_all(false);
  config_request_ = encoder_request_ = io_request_ = joystick_request_ = Request::No;
}

void P3At::execute(const arcos::Command& command) {
  const bool was_stopped = watchdog_stopped_;
  watchdog_stopped_ = false;
  t_last_command_ns_ = t_ns_;
  if (command.is(CommandId::Open)) {
    if (session_ == Session::Connected) open();
  } else if (command.is(CommandId::Close)) {
    close();
  } else {  // PULSE and unknown commands have no effect but on the watchdog
    execute_motion(command) || execute_limits(command) || execute_requests(command) ||
        execute_parameters(command) || execute_tuning(command);
  }
  if (was_stopped && session_ == Session::Open) {
    const bool resumes = motors_enabled_ && drive_.has_motion_to_do(progress());
    log(RobotEventKind::WatchdogResume, resumes ? 1 : 0);
  }
}

}  // namespace heel::sim
