// The command table: the effect of each command on the P3-AT. Wire units are converted to SI units here.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "sim/robot/make_config.h"
#include "sim/robot/p3at.h"

namespace heel::sim {
namespace {

using arcos::CommandId;

constexpr double metres(int mm) {
  return mm * 1e-3;
}
constexpr double radians(int degrees) {
  return degrees * std::numbers::pi / 180.0;
}

/// SETA, SETRA: the sign selects acceleration or deceleration. Zero is ignored: the robot could never move or
/// never stop.
void set_acceleration(AxisLimits& limits, double value, const AxisLimits& top) {
  if (value > 0.0) limits.acceleration = std::min(value, top.acceleration);
  if (value < 0.0) limits.deceleration = std::min(-value, top.deceleration);
}

}  // namespace

bool P3At::execute_motion(const arcos::Command& command) {
  const Drive::Progress now = progress();
  const int value = command.value;
  switch (static_cast<CommandId>(command.id)) {
    case CommandId::Enable:
      enable(value != 0);
      return true;
    case CommandId::Vel:
      drive_.set_speed(metres(value));
      return true;
    case CommandId::RVel:
    case CommandId::Rotate:
      drive_.set_yaw_rate(radians(value));
      return true;
    case CommandId::Vel2: {
      const arcos::WheelSpeeds wheels = arcos::wheel_speeds_of_vel2(command);
      drive_.set_wheels({metres(wheels.left_mm_s), metres(wheels.right_mm_s)});
      return true;
    }
    case CommandId::Move:
      drive_.move(metres(value), now.travelled_m);
      return true;
    case CommandId::Head:
      drive_.turn_to(radians(value));
      return true;
    case CommandId::DHead:
      drive_.turn_to(now.heading_rad + radians(value));
      return true;
    case CommandId::DcHead:
      drive_.turn_to(drive_.heading_setpoint_rad(now.heading_rad) + radians(value));
      return true;
    case CommandId::Stop:
      drive_.stop();
      return true;
    case CommandId::EStop:
      drive_.emergency_stop();
      return true;
    default:
      return false;
  }
}

bool P3At::execute_limits(const arcos::Command& command) {
  const double degree = radians(1);
  const AxisLimits& top_deg = settings_.rotation_top_deg;
  const AxisLimits top{top_deg.speed * degree, top_deg.acceleration * degree, top_deg.deceleration * degree};
  const int value = command.value;
  switch (static_cast<CommandId>(command.id)) {
    case CommandId::SetV:
      drive_.translation_limits.speed = std::min(metres(std::abs(value)), settings_.translation_top.speed);
      return true;
    case CommandId::SetRv:
      drive_.rotation_limits.speed = std::min(radians(std::abs(value)), top.speed);
      return true;
    case CommandId::SetA:
      set_acceleration(drive_.translation_limits, metres(value), settings_.translation_top);
      return true;
    case CommandId::SetRa:
      set_acceleration(drive_.rotation_limits, radians(value), top);
      return true;
    case CommandId::SetO:
      drive_.zero_heading(chassis_.odometry().heading_rad);
      chassis_.zero_odometry();
      return true;
    case CommandId::BumpStall:
      bump_stall_ = value & 3;
      return true;
    case CommandId::EStall:
      e_stall_on_button_ = value != 0;
      return true;
    default:
      return false;
  }
}

bool P3At::execute_requests(const arcos::Command& command) {
  const auto request = [&command] {
    return command.value <= 0 ? Request::No : command.value == 1 ? Request::Once : Request::Stream;
  };
  switch (static_cast<CommandId>(command.id)) {
    case CommandId::Config:
      if (settings_.sends_config) config_request_ = Request::Once;
      break;
    case CommandId::Encoder:
      encoder_request_ = request();
      break;
    case CommandId::IoRequest:
      io_request_ = request();
      break;
    case CommandId::JoyRequest:
      joystick_request_ = request();
      break;
    default:
      return false;
  }
  if (session_ != Session::Open) send_requested_packets();  // otherwise with the next SIP
  return true;
}

bool P3At::execute_parameters(const arcos::Command& command) {
  switch (static_cast<CommandId>(command.id)) {
    case CommandId::Sonar:
      switch_sonar(command.value);
      return true;
    case CommandId::SonarCycle:
      if (command.value > 0) sonar_.set_cycle(command.value * kNsPerMs);
      return true;
    case CommandId::Polling:
      sonar_.set_polling(command.text);
      return true;
    case CommandId::DigOut: {
      const unsigned mask = command.word() >> 8;
      digital_out_ = static_cast<std::uint8_t>((digital_out_ & ~mask) | (command.word() & mask));
      return true;
    }
    case CommandId::AdSel:
      ad_port_ = static_cast<std::uint8_t>(command.value);
      return true;
    case CommandId::HostBaud:
      change_baud(command.value);
      return true;
    case CommandId::BatTest:
      battery_test_v_ = 0.1 * std::abs(command.value);
      return true;
    case CommandId::Reset:
      reset();
      return true;
    case CommandId::Maintenance:
      forget_session();
      session_ = Session::Maintenance;
      log(RobotEventKind::Maintenance);
      return true;
    default:
      return false;
  }
}

/// Constants of the firmware's controllers. CONFIGpac reports them; only TICKSMM has an effect in this model.
bool P3At::execute_tuning(const arcos::Command& command) {
  const auto word = static_cast<std::uint16_t>(command.value);
  switch (static_cast<CommandId>(command.id)) {
    case CommandId::RotKp:
      config_.rot_kp = word;
      return true;
    case CommandId::RotKv:
      config_.rot_kv = word;
      return true;
    case CommandId::RotKi:
      config_.rot_ki = word;
      return true;
    case CommandId::TransKp:
      config_.trans_kp = word;
      return true;
    case CommandId::TransKv:
      config_.trans_kv = word;
      return true;
    case CommandId::TransKi:
      config_.trans_ki = word;
      return true;
    case CommandId::RevCount:
      config_.rev_count = word;
      return true;
    case CommandId::DriftFactor:
      config_.drift_factor = static_cast<std::int16_t>(command.value);
      return true;
    case CommandId::TicksMm:
      config_.ticks_mm = word;
      return true;
    default:
      return false;
  }
}

void P3At::enable(bool on) {
  if (on && stop_button_) {
    log(RobotEventKind::EnableRefused);
    return;
  }
  if (on) e_stall_engaged_ = false;
  if (on != motors_enabled_) log(on ? RobotEventKind::Enabled : RobotEventKind::Disabled);
  motors_enabled_ = on;
}

void P3At::switch_sonar(int argument) {
  const bool on = (argument & 1) != 0;
  const int array = argument >> 1 & 7;
  if (array == 0) {
    sonar_.enable_all(on);
  } else if (array <= sonar_.arrays()) {
    sonar_.enable(array - 1, on);
  }
}

void P3At::change_baud(int code) {
  if (settings_.autobaud == 0 || code < 0 || code >= static_cast<int>(std::size(kBauds))) return;
  line_.set_robot_baud(kBauds[code]);
  log(RobotEventKind::BaudChanged, kBauds[code]);
}

}  // namespace heel::sim
