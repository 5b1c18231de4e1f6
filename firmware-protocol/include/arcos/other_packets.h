/// \file
/// The smaller packets: the echo of SYNC2, ENCODER, IO and the controller's reset notice.
///
/// - Units: ticks and raw values of the wire.
/// - Errors: a DecodeResult; encoding a packet that is too long gives an empty Frame.
/// - Source: MobileRobots Inc., "Pioneer 3 Operations Manual", 2006, chapter on ARCOS, server information
///   packets.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "arcos/packet.h"

namespace arcos {

inline constexpr std::uint8_t kEncoderPacketId = 0x90;
inline constexpr std::uint8_t kIoPacketId = 0xF0;
inline constexpr std::uint8_t kGyroPacketId = 0x98;
inline constexpr std::uint8_t kJoystickPacketId = 0xF8;
/// The controller has reset: odometry is zero, the connection is closed.
constexpr bool is_reset_notice(std::uint8_t id) {
  return id == 0xFE || id == 0xFF;
}

/// The echo of SYNC2.
struct RobotIdentity {
  Text name;
  Text robot_class;  ///< "Pioneer"
  Text subclass;     ///< "p3at-sh"
  friend bool operator==(const RobotIdentity&, const RobotIdentity&) = default;
};
DecodeResult decode_sync2_echo(std::span<const std::uint8_t> body, RobotIdentity& out);
Frame encode_sync2_echo(const RobotIdentity& identity);

/// The wheel encoders' counts.
struct EncoderPacket {
  std::int32_t left_ticks = 0;
  std::int32_t right_ticks = 0;
  friend bool operator==(const EncoderPacket&, const EncoderPacket&) = default;
};
DecodeResult decode_encoder(std::span<const std::uint8_t> body, EncoderPacket& out);
Frame encode_encoder(const EncoderPacket& encoder);

/// Digital and analog ports. Each list is preceded by its length on the wire.
struct IoPacket {
  static constexpr std::size_t kMaxBytes = 16;
  static constexpr std::size_t kMaxAnalogs = 32;
  std::uint8_t input_count = 0;
  std::array<std::uint8_t, kMaxBytes> inputs{};
  std::uint8_t output_count = 0;
  std::array<std::uint8_t, kMaxBytes> outputs{};
  std::uint8_t analog_count = 0;
  std::array<std::uint16_t, kMaxAnalogs> analogs{};
  friend bool operator==(const IoPacket&, const IoPacket&) = default;
};
/// Lists longer than IoPacket holds are read as Truncated.
DecodeResult decode_io(std::span<const std::uint8_t> body, IoPacket& out);
Frame encode_io(const IoPacket& io);

}  // namespace arcos
