/// \file
/// Commands to bytes and back.
///
/// - Convention: what may be encoded stands in command_table().
/// - Units: those of the command's meaning in the table; VEL2 in mm/s.
/// - Errors: an argument that the table does not allow, an id that is never to be sent, or more than
///   kMaxSentCount bytes give an empty Frame; decoding gives a DecodeResult.
/// - Source: MobileRobots Inc., "Pioneer 3 Operations Manual", 2006, chapter on ARCOS.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "arcos/commands.h"
#include "arcos/packet.h"

namespace arcos {

/// The argument's type byte on the wire.
enum class ArgumentType : std::uint8_t { None = 0, Positive = 0x3B, Negative = 0x1B, Text = 0x2B };

inline constexpr int kVel2Step_mm_s = 20;  ///< unit of the VEL2 bytes
/// Largest VEL2 byte sent. A client that clamps at 128 sends −128 instead: stay well below.
inline constexpr int kVel2MaxSteps = 120;

/// A command without argument.
Frame encode_plain(CommandId id);
/// A command with an integer; negative ones only where the table allows them.
Frame encode_integer(CommandId id, std::int16_t value);
/// A command with a text: length, then bytes.
Frame encode_text(CommandId id, std::string_view text);
/// Wheel speeds, rounded to 20 mm/s and clamped to ±kVel2MaxSteps.
Frame encode_vel2(int left_mm_s, int right_mm_s);
/// Digital outputs: the bits of `mask` are set to those of `values`.
Frame encode_digout(std::uint8_t mask, std::uint8_t values);

/// A command as received. `text` borrows the body it was decoded from.
struct Command {
  std::uint8_t id = 0;  ///< need not be in the table
  ArgumentType type = ArgumentType::None;
  std::int32_t value = 0;  ///< 3B: 0…65535; 1B: −65535…0
  std::span<const std::uint8_t> text;
  std::size_t trailing_bytes = 0;  ///< bytes after the argument, ignored

  /// Whether it is the command `wanted`.
  bool is(CommandId wanted) const { return id == static_cast<std::uint8_t>(wanted); }
  bool has_integer() const { return type == ArgumentType::Positive || type == ArgumentType::Negative; }
  /// The argument as the 16-bit word of two bytes it is for VEL2 and DIGOUT.
  std::uint16_t word() const { return static_cast<std::uint16_t>(value); }
};

/// Accepts what clients send: a lone type byte without argument counts as no argument.
DecodeResult decode_command(std::span<const std::uint8_t> body, Command& out);

/// The argument of VEL2.
struct WheelSpeeds {
  int left_mm_s = 0;
  int right_mm_s = 0;
};
/// Left is the high byte, right the low one, each signed, × 20 mm/s.
WheelSpeeds wheel_speeds_of_vel2(const Command& vel2);

}  // namespace arcos
