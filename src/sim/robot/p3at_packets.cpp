// The packets of the P3-AT: SIP, CONFIGpac and those sent on request. SI units are converted to wire units
// here.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "arcos/other_packets.h"
#include "sim/robot/make_config.h"
#include "sim/robot/p3at.h"

namespace heel::sim {
namespace {

constexpr std::size_t kReadingsInSip = 16;

/// Rounded and wrapped to 16 bits, as the firmware's counters are.
std::uint16_t wrapped(double value) {
  return static_cast<std::uint16_t>(std::llround(value));
}

std::int16_t clamped_i16(double value) {
  return static_cast<std::int16_t>(std::clamp(std::lround(value), -32768L, 32767L));
}

std::int16_t angle_units(double angle_rad, bool from_zero) {
  constexpr double kUnitsPerRad = 4096.0 / (2.0 * std::numbers::pi);
  const int units = wrapped(angle_rad * kUnitsPerRad) % 4096;
  return static_cast<std::int16_t>(!from_zero && units >= 2048 ? units - 4096 : units);
}

std::uint8_t compass_units(double heading_rad) {
  const double degrees = std::remainder(-heading_rad * 180.0 / std::numbers::pi, 360.0);
  return static_cast<std::uint8_t>(std::lround((degrees < 0.0 ? degrees + 360.0 : degrees) / 2.0) % 180);
}

}  // namespace

void P3At::send_requested_packets() {
  const auto due = [](Request& request) {
    const bool send_now = request != Request::No;
    if (request == Request::Once) request = Request::No;
    return send_now;
  };
  if (due(config_request_)) send_config();
  if (due(encoder_request_)) send(make_encoder_packet());
  if (due(io_request_)) send(make_io_packet());
  if (due(joystick_request_)) send(make_joystick_packet());
}

void P3At::send_config() {
  const arcos::Frame frame = arcos::encode_config(config_);
  std::vector<std::uint8_t> bytes(frame.bytes().begin(), frame.bytes().end());
  if (faults_.effects().bad_config) bytes.back() = static_cast<std::uint8_t>(bytes.back() ^ 0x5A);
  line_.from_robot(bytes, t_ns_);
}

arcos::Sip P3At::make_sip() {
  const RobotTruth now = truth();
  const WheelSpeeds& wheels = now.wheels;
  arcos::Sip sip;
  const RobotModel& model = settings_.model;
  const double units_per_m = 1000.0 / model.mm_per_position_unit;
  const double speed_units_per_m_s = 1000.0 / model.mm_s_per_speed_unit;
  sip.x_pos = wrapped(now.odometry.x_m * units_per_m);
  sip.y_pos = wrapped(now.odometry.y_m * units_per_m);
  sip.th_pos = angle_units(now.odometry.heading_rad, settings_.heading_from_zero);
  sip.left_mm_s = clamped_i16(wheels.left_m_s * speed_units_per_m_s);
  sip.right_mm_s = clamped_i16(wheels.right_m_s * speed_units_per_m_s);
  sip.id = sip.left_mm_s != 0 || sip.right_mm_s != 0 ? arcos::kSipMoving : arcos::kSipStanding;

  const double drained_v = settings_.battery_drain_v_per_h * seconds_from_ns(t_ns_) / 3600.0;
  const double battery_v =
      battery_test_v_ > 0.0 ? battery_test_v_ : std::max(0.0, settings_.battery_v - drained_v);
  const std::uint16_t battery_dv = wrapped(battery_v * 10.0);
  sip.battery_dv = static_cast<std::uint8_t>(std::min<int>(battery_dv, 255));
  sip.stall_and_bumpers =
      arcos::stall_and_bumpers_word(now.stall_left, now.stall_right, now.bumpers_front, now.bumpers_rear);
  sip.control =
      angle_units(drive_.heading_setpoint_rad(now.odometry.heading_rad), settings_.heading_from_zero);
  unsigned flags = arcos::kFlagPowerGood;
  if (motors_enabled_) flags |= arcos::kFlagMotorsEnabled;
  for (int array = 0; array < sonar_.arrays(); ++array) {
    if (sonar_.enabled(array)) flags |= 2u << array;
  }
  if (stop_button_) flags |= arcos::kFlagStopButton;
  if (e_stall_engaged_) flags |= arcos::kFlagEStall;
  sip.flags = static_cast<std::uint16_t>(flags);
  sip.compass_2deg = compass_units(now.pose.heading_rad);

  for (const SonarReading& reading : sonar_.take_readings()) {
    if (sip.sonar_count < kReadingsInSip) sip.sonars[sip.sonar_count++] = {reading.number, reading.range};
  }
  sip.gripper = std::uint8_t{0};
  sip.ad_port = ad_port_;
  sip.analog = std::uint8_t{0};
  sip.digital_in = std::uint8_t{0};
  sip.digital_out = digital_out_;
  sip.battery_long_dv = battery_dv;
  sip.charge_state = static_cast<std::uint8_t>(settings_.charge_state);
  const double turn_rad_s = (wheels.right_m_s - wheels.left_m_s) / settings_.chassis.effective_track_m;
  sip.rotation_ddeg_s = clamped_i16(turn_rad_s * 1800.0 / std::numbers::pi);
  if (settings_.sends_fault_flags) sip.fault_flags = std::uint16_t{0};
  return sip;
}

arcos::Frame P3At::make_encoder_packet() const {
  const double ticks_per_m = 1000.0 * config_.ticks_mm.value_or(1);
  const auto ticks = [ticks_per_m](double travel_m) {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(std::llround(travel_m * ticks_per_m)));
  };
  return arcos::encode_encoder({ticks(chassis_.left_travel_m()), ticks(chassis_.right_travel_m())});
}

arcos::Frame P3At::make_io_packet() const {
  arcos::IoPacket io;
  io.input_count = 4;
  io.output_count = 1;
  io.outputs[0] = digital_out_;
  io.analog_count = 9;
  return arcos::encode_io(io);
}

arcos::Frame P3At::make_joystick_packet() const {
  constexpr std::uint16_t kCentre = 512;
  arcos::PacketWriter packet(arcos::kJoystickPacketId);
  packet.u8(0);  // no button
  packet.u8(0);
  packet.u16(kCentre);
  packet.u16(kCentre);
  packet.u16(0);  // throttle
  return packet.finish();
}

}  // namespace heel::sim
