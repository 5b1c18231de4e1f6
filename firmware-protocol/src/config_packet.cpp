#include "arcos/config_packet.h"

#include "field_order.h"

namespace arcos {
namespace {

template <typename Visitor, typename Config>
void visit_fields(Visitor& v, Config& config) {
  v.field(config.type);
  v.field(config.subtype);
  v.field(config.serial);
  v.field(config.four_motors);
  v.field(config.rot_vel_top);
  v.field(config.trans_vel_top);
  v.field(config.rot_acc_top);
  v.field(config.trans_acc_top);
  v.field(config.pwm_max);
  v.field(config.name);
  v.field(config.sip_cycle_ms);
  v.field(config.host_baud);
  v.field(config.aux1_baud);
  v.field(config.gripper);
  v.field(config.front_sonar);
  v.field(config.rear_sonar);
  v.field(config.low_battery_dv);
  v.field(config.rev_count);
  v.field(config.watchdog_ms);
  v.field(config.p2_mpacs);
  v.field(config.stall_val);
  v.field(config.stall_count_ms);
  v.field(config.joy_vel);
  v.field(config.joy_rvel);
  v.field(config.rot_vel_max);
  v.field(config.trans_vel_max);
  v.field(config.rot_acc);
  v.field(config.rot_decel);
  v.field(config.rot_kp);
  v.field(config.rot_kv);
  v.field(config.rot_ki);
  v.field(config.trans_acc);
  v.field(config.trans_decel);
  v.field(config.trans_kp);
  v.field(config.trans_kv);
  v.field(config.trans_ki);
  v.tail(config.front_bumps);
  v.tail(config.rear_bumps);
  v.tail(config.charger);
  v.tail(config.sonar_cycle_ms);
  v.tail(config.autobaud);
  v.tail(config.has_gyro);
  v.tail(config.drift_factor);
  v.tail(config.aux2_baud);
  v.tail(config.aux3_baud);
  v.tail(config.ticks_mm);
  v.tail(config.shutdown_dv);
  v.tail(config.version);
  v.tail(config.gyro_cw);
  v.tail(config.gyro_ccw);
  v.tail(config.kinematics_delay);
}

}  // namespace

DecodeResult decode_config(std::span<const std::uint8_t> body, ConfigPacket& out) {
  out = ConfigPacket{};
  PacketReader reader(body);
  const std::uint8_t id = reader.u8();
  if (!reader.truncated() && id != kConfigPacketId) return DecodeResult::WrongId;
  detail::FieldReader fields(reader);
  visit_fields(fields, out);
  return reader.result();
}

Frame encode_config(const ConfigPacket& config) {
  PacketWriter writer(kConfigPacketId);
  detail::FieldWriter fields(writer);
  visit_fields(fields, config);
  return writer.finish();
}

}  // namespace arcos
