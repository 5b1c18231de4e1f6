#include "arcos/sip.h"

#include "field_order.h"

namespace arcos {
namespace {

template <typename Visitor, typename SipType>
void visit_fixed_fields(Visitor& v, SipType& sip) {
  v.field(sip.x_pos);
  v.field(sip.y_pos);
  v.field(sip.th_pos);
  v.field(sip.left_mm_s);
  v.field(sip.right_mm_s);
  v.field(sip.battery_dv);
  v.field(sip.stall_and_bumpers);
  v.field(sip.control);
  v.field(sip.flags);
  v.field(sip.compass_2deg);
  v.field(sip.sonar_count);
}

template <typename Visitor, typename SipType>
void visit_sonars(Visitor& v, SipType& sip) {
  for (std::size_t i = 0; i < sip.sonar_count; ++i) {
    v.field(sip.sonars[i].number);
    v.field(sip.sonars[i].range_mm);
  }
}

template <typename Visitor, typename SipType>
void visit_tail(Visitor& v, SipType& sip) {
  v.tail(sip.gripper);
  v.tail(sip.ad_port);
  v.tail(sip.analog);
  v.tail(sip.digital_in);
  v.tail(sip.digital_out);
  v.tail(sip.battery_long_dv);
  v.tail(sip.charge_state);
  v.tail(sip.rotation_ddeg_s);
  v.tail(sip.fault_flags);
}

}  // namespace

DecodeResult decode_sip(std::span<const std::uint8_t> body, Sip& out) {
  out = Sip{};
  PacketReader reader(body);
  out.id = reader.u8();
  if (!reader.truncated() && !is_sip(out.id)) return DecodeResult::WrongId;
  detail::FieldReader fields(reader);
  visit_fixed_fields(fields, out);
  if (out.sonar_count > kMaxSonarReadings) {  // more than the longest packet can hold
    out.sonar_count = 0;
    return DecodeResult::Truncated;
  }
  visit_sonars(fields, out);
  visit_tail(fields, out);
  return reader.result();
}

Frame encode_sip(const Sip& sip) {
  if (sip.sonar_count > kMaxSonarReadings) return Frame{};
  PacketWriter writer(sip.id);
  detail::FieldWriter fields(writer);
  visit_fixed_fields(fields, sip);
  visit_sonars(fields, sip);
  visit_tail(fields, sip);
  return writer.finish();
}

}  // namespace arcos
