#include "arcos/command_codec.h"

#include <algorithm>

namespace arcos {
namespace {

constexpr std::size_t kMaxTextArgument = 255;  // its length is one byte

const CommandInfo* sendable(CommandId id) {
  const CommandInfo* const info = find_command(id);
  return info != nullptr && info->may_be_sent ? info : nullptr;
}

PacketWriter writer_for(CommandId id) {
  return PacketWriter(static_cast<std::uint8_t>(id), kMaxSentCount);
}

Frame encode_signed_word(CommandId id, std::int16_t value) {
  const std::int32_t wide = value;  // the magnitude of −32768 needs more than 16 bits
  PacketWriter writer = writer_for(id);
  writer.u8(static_cast<std::uint8_t>(wide < 0 ? ArgumentType::Negative : ArgumentType::Positive));
  writer.u16(static_cast<std::uint16_t>(wide < 0 ? -wide : wide));
  return writer.finish();
}

int vel2_steps(int v_mm_s) {
  const int half = v_mm_s < 0 ? -kVel2Step_mm_s / 2 : kVel2Step_mm_s / 2;
  const int limit_mm_s = kVel2MaxSteps * kVel2Step_mm_s;
  return (std::clamp(v_mm_s, -limit_mm_s, limit_mm_s) + half) / kVel2Step_mm_s;
}

}  // namespace

Frame encode_plain(CommandId id) {
  const CommandInfo* const info = sendable(id);
  if (info == nullptr) return Frame{};
  if (info->argument != ArgumentKind::None && info->argument != ArgumentKind::OptionalInteger) return Frame{};
  return writer_for(id).finish();
}

Frame encode_integer(CommandId id, std::int16_t value) {
  const CommandInfo* const info = sendable(id);
  if (info == nullptr) return Frame{};
  const bool takes_sign = info->argument == ArgumentKind::SignedInteger;
  const bool takes_integer =
      info->argument == ArgumentKind::Integer || info->argument == ArgumentKind::OptionalInteger;
  if (!takes_sign && !(takes_integer && value >= 0)) return Frame{};
  return encode_signed_word(id, value);
}

Frame encode_text(CommandId id, std::string_view text) {
  const CommandInfo* const info = sendable(id);
  if (info == nullptr || info->argument != ArgumentKind::Text || text.size() > kMaxTextArgument) {
    return Frame{};
  }
  PacketWriter writer = writer_for(id);
  writer.u8(static_cast<std::uint8_t>(ArgumentType::Text));
  writer.u8(static_cast<std::uint8_t>(text.size()));
  writer.raw(text);
  return writer.finish();
}

Frame encode_vel2(int left_mm_s, int right_mm_s) {
  const auto left = static_cast<std::uint8_t>(vel2_steps(left_mm_s));
  const auto right = static_cast<std::uint8_t>(vel2_steps(right_mm_s));
  return encode_signed_word(CommandId::Vel2, static_cast<std::int16_t>(left << 8 | right));
}

Frame encode_digout(std::uint8_t mask, std::uint8_t values) {
  PacketWriter writer = writer_for(CommandId::DigOut);
  writer.u8(static_cast<std::uint8_t>(ArgumentType::Positive));
  writer.u8(values);
  writer.u8(mask);
  return writer.finish();
}

DecodeResult decode_command(std::span<const std::uint8_t> body, Command& out) {
  out = Command{};
  if (body.empty()) return DecodeResult::Truncated;
  PacketReader reader(body);
  out.id = reader.u8();
  if (reader.left() == 0) return DecodeResult::Ok;

  const auto type = static_cast<ArgumentType>(reader.u8());
  switch (type) {
    case ArgumentType::Positive:
    case ArgumentType::Negative:
      if (reader.left() == 0) return DecodeResult::Ok;  // as p2os sends SETO
      out.value = type == ArgumentType::Positive ? reader.u16() : -static_cast<std::int32_t>(reader.u16());
      break;
    case ArgumentType::Text:
      out.text = reader.raw(reader.u8());
      break;
    case ArgumentType::None:
    default:
      return DecodeResult::BadArgumentType;
  }
  out.type = type;
  out.trailing_bytes = reader.left();
  return reader.result();
}

WheelSpeeds wheel_speeds_of_vel2(const Command& vel2) {
  const auto left = static_cast<std::int8_t>(vel2.word() >> 8);
  const auto right = static_cast<std::int8_t>(vel2.word() & 0xFF);
  return {left * kVel2Step_mm_s, right * kVel2Step_mm_s};
}

}  // namespace arcos
