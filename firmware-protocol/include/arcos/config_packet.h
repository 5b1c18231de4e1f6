/// \file
/// CONFIGpac: the controller's settings, sent when CONFIG asks for them. Optional: on some robots it never
/// passes its checksum.
///
/// - Units: fields keep the names and units of the wire.
/// - Errors: a DecodeResult; encoding a packet that is too long gives an empty Frame.
/// - Source: MobileRobots Inc., "Pioneer 3 Operations Manual", 2006, chapter on ARCOS, configuration packet.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "arcos/packet.h"

namespace arcos {

inline constexpr std::uint8_t kConfigPacketId = 0x20;

/// In wire order. Speeds mm/s and deg/s, accelerations mm/s² and deg/s².
struct ConfigPacket {
  Text type;  ///< "Pioneer"
  Text subtype;
  Text serial;
  std::uint8_t four_motors = 0;
  std::uint16_t rot_vel_top = 0;  ///< *_top: hardware limits no command can pass
  std::uint16_t trans_vel_top = 0;
  std::uint16_t rot_acc_top = 0;
  std::uint16_t trans_acc_top = 0;
  std::uint16_t pwm_max = 0;
  Text name;
  std::uint8_t sip_cycle_ms = 0;
  std::uint8_t host_baud = 0;  ///< 0…4: 9600, 19200, 38400, 57600, 115200
  std::uint8_t aux1_baud = 0;
  std::uint16_t gripper = 0;
  std::uint16_t front_sonar = 0;
  std::uint8_t rear_sonar = 0;
  std::uint16_t low_battery_dv = 0;
  std::uint16_t rev_count = 0;
  std::uint16_t watchdog_ms = 0;
  std::uint8_t p2_mpacs = 0;
  std::uint16_t stall_val = 0;  ///< PWM above which a standing wheel counts as stalled
  std::uint16_t stall_count_ms = 0;
  std::uint16_t joy_vel = 0;
  std::uint16_t joy_rvel = 0;
  std::uint16_t rot_vel_max = 0;
  std::uint16_t trans_vel_max = 0;
  std::uint16_t rot_acc = 0;
  std::uint16_t rot_decel = 0;
  std::uint16_t rot_kp = 0;
  std::uint16_t rot_kv = 0;
  std::uint16_t rot_ki = 0;
  std::uint16_t trans_acc = 0;
  std::uint16_t trans_decel = 0;
  std::uint16_t trans_kp = 0;
  std::uint16_t trans_kv = 0;
  std::uint16_t trans_ki = 0;
  // Added by later firmware, in this order: a robot may end its packet before any of these.
  std::optional<std::uint8_t> front_bumps;
  std::optional<std::uint8_t> rear_bumps;
  std::optional<std::uint8_t> charger;
  std::optional<std::uint8_t> sonar_cycle_ms;
  std::optional<std::uint8_t> autobaud;  ///< 1 changeable, 2 automatic
  std::optional<std::uint8_t> has_gyro;  ///< 1 client's, 2 server's
  std::optional<std::int16_t> drift_factor;
  std::optional<std::uint8_t> aux2_baud;
  std::optional<std::uint8_t> aux3_baud;
  std::optional<std::uint16_t> ticks_mm;
  std::optional<std::uint16_t> shutdown_dv;
  std::optional<Text> version;
  std::optional<std::uint16_t> gyro_cw;
  std::optional<std::uint16_t> gyro_ccw;
  std::optional<std::uint8_t> kinematics_delay;
  friend bool operator==(const ConfigPacket&, const ConfigPacket&) = default;
};

/// Bytes after the last known field are ignored.
DecodeResult decode_config(std::span<const std::uint8_t> body, ConfigPacket& out);
Frame encode_config(const ConfigPacket& config);

}  // namespace arcos
