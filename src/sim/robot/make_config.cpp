#include "sim/robot/make_config.h"

#include <cmath>

namespace heel::sim {
namespace {

std::uint16_t word(double value) {
  return static_cast<std::uint16_t>(std::lround(value));
}

std::uint8_t baud_code(int baud) {
  for (std::size_t code = 0; code < std::size(kBauds); ++code) {
    if (kBauds[code] == baud) return static_cast<std::uint8_t>(code);
  }
  return 0;
}

}  // namespace

arcos::ConfigPacket make_config(const P3AtSettings& settings) {
  arcos::ConfigPacket config;
  config.type = arcos::Text(settings.type);
  config.subtype = arcos::Text(settings.subtype);
  config.serial = arcos::Text(settings.serial_number);
  config.four_motors = 1;
  config.rot_vel_top = word(settings.rotation_top_deg.speed);
  config.trans_vel_top = word(settings.translation_top.speed * 1e3);
  config.rot_acc_top = word(settings.rotation_top_deg.acceleration);
  config.trans_acc_top = word(settings.translation_top.acceleration * 1e3);
  config.pwm_max = 500;
  config.name = arcos::Text(settings.name);
  config.sip_cycle_ms = static_cast<std::uint8_t>(settings.sip_cycle_ns / kNsPerMs);
  config.host_baud = baud_code(settings.boot_baud);
  config.front_sonar = 1;
  config.rear_sonar = 1;
  config.low_battery_dv = 115;
  config.rev_count = 22500;
  config.watchdog_ms = static_cast<std::uint16_t>(settings.watchdog_ns / kNsPerMs);
  config.p2_mpacs = 1;
  config.stall_val = 200;
  config.stall_count_ms = static_cast<std::uint16_t>(settings.stall_cut_ns / kNsPerMs);
  config.joy_vel = 600;
  config.joy_rvel = 50;
  config.rot_vel_max = word(settings.rotation_boot_deg.speed);
  config.trans_vel_max = word(settings.translation_boot.speed * 1e3);
  config.rot_acc = word(settings.rotation_boot_deg.acceleration);
  config.rot_decel = word(settings.rotation_boot_deg.deceleration);
  config.rot_kp = 30;
  config.rot_kv = 60;
  config.trans_acc = word(settings.translation_boot.acceleration * 1e3);
  config.trans_decel = word(settings.translation_boot.deceleration * 1e3);
  config.trans_kp = 30;
  config.trans_kv = 60;
  config.front_bumps = std::uint8_t{5};
  config.rear_bumps = std::uint8_t{5};
  config.charger = std::uint8_t{0};
  config.sonar_cycle_ms = static_cast<std::uint8_t>(settings.sonar_cycle_ns / kNsPerMs);
  config.autobaud = static_cast<std::uint8_t>(settings.autobaud);
  config.has_gyro = std::uint8_t{0};
  config.drift_factor = std::int16_t{0};
  config.aux2_baud = std::uint8_t{0};
  config.aux3_baud = std::uint8_t{0};
  config.ticks_mm = static_cast<std::uint16_t>(settings.ticks_per_mm);
  config.shutdown_dv = std::uint16_t{110};
  config.version = arcos::Text(settings.firmware_version);
  config.gyro_cw = std::uint16_t{0};
  config.gyro_ccw = std::uint16_t{0};
  config.kinematics_delay = std::uint8_t{0};
  return config;
}

}  // namespace heel::sim
