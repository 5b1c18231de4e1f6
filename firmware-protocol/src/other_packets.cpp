#include "arcos/other_packets.h"

#include <algorithm>

#include "arcos/commands.h"
#include "field_order.h"

namespace arcos {
namespace {

constexpr auto kSync2 = static_cast<std::uint8_t>(CommandId::Sync2);

bool is_other_id(PacketReader& reader, std::uint8_t wanted) {
  const std::uint8_t id = reader.u8();
  return !reader.truncated() && id != wanted;
}

/// A length byte and that many elements; false when `list` cannot hold them.
template <typename T, std::size_t N>
bool read_list(detail::FieldReader& fields, std::uint8_t& count, std::array<T, N>& list) {
  fields.field(count);
  if (count > N) {
    count = 0;
    return false;
  }
  for (T& element : std::span(list).first(count)) fields.field(element);
  return true;
}

template <typename T, std::size_t N>
void write_list(PacketWriter& writer, std::uint8_t count, const std::array<T, N>& list) {
  detail::FieldWriter fields(writer);
  fields.field(count);
  for (const T element : std::span(list).first(count)) fields.field(element);
}

}  // namespace

DecodeResult decode_sync2_echo(std::span<const std::uint8_t> body, RobotIdentity& out) {
  PacketReader reader(body);
  if (is_other_id(reader, kSync2)) return DecodeResult::WrongId;
  out.name = reader.text();
  out.robot_class = reader.text();
  out.subclass = reader.text();
  return reader.result();
}

Frame encode_sync2_echo(const RobotIdentity& identity) {
  PacketWriter writer(kSync2);
  writer.text(identity.name);
  writer.text(identity.robot_class);
  writer.text(identity.subclass);
  return writer.finish();
}

DecodeResult decode_encoder(std::span<const std::uint8_t> body, EncoderPacket& out) {
  PacketReader reader(body);
  if (is_other_id(reader, kEncoderPacketId)) return DecodeResult::WrongId;
  out.left_ticks = reader.i32();
  out.right_ticks = reader.i32();
  return reader.result();
}

Frame encode_encoder(const EncoderPacket& encoder) {
  PacketWriter writer(kEncoderPacketId);
  writer.i32(encoder.left_ticks);
  writer.i32(encoder.right_ticks);
  return writer.finish();
}

DecodeResult decode_io(std::span<const std::uint8_t> body, IoPacket& out) {
  out = IoPacket{};
  PacketReader reader(body);
  if (is_other_id(reader, kIoPacketId)) return DecodeResult::WrongId;
  detail::FieldReader fields(reader);
  const bool fits = read_list(fields, out.input_count, out.inputs) &&
                    read_list(fields, out.output_count, out.outputs) &&
                    read_list(fields, out.analog_count, out.analogs);
  return fits ? reader.result() : DecodeResult::Truncated;
}

Frame encode_io(const IoPacket& io) {
  const bool fits = io.input_count <= IoPacket::kMaxBytes && io.output_count <= IoPacket::kMaxBytes &&
                    io.analog_count <= IoPacket::kMaxAnalogs;
  if (!fits) return Frame{};
  PacketWriter writer(kIoPacketId);
  write_list(writer, io.input_count, io.inputs);
  write_list(writer, io.output_count, io.outputs);
  write_list(writer, io.analog_count, io.analogs);
  return writer.finish();
}

}  // namespace arcos
