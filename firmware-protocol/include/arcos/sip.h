/// \file
/// The standard information packet (SIP): what the robot reports every cycle.
///
/// - Convention: heading and rotation counter-clockwise positive; bumper segments from bit 0.
/// - Units: fields keep the names and units of the wire.
/// - Errors: a DecodeResult; encoding too many sonar readings gives an empty Frame.
/// - Source: MobileRobots Inc., "Pioneer 3 Operations Manual", 2006, chapter on ARCOS, standard SIP.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "arcos/packet.h"

namespace arcos {

inline constexpr std::uint8_t kSipStanding = 0x32;
inline constexpr std::uint8_t kSipMoving = 0x33;
inline constexpr std::uint8_t kSipFirstId = 0x30;  ///< accepted range
inline constexpr std::uint8_t kSipLastId = 0x34;
/// Whether a packet with this id is a SIP.
constexpr bool is_sip(std::uint8_t id) {
  return id >= kSipFirstId && id <= kSipLastId;
}

/// Bits of Sip::flags.
enum SipFlag : std::uint16_t {
  kFlagMotorsEnabled = 1u << 0,
  kFlagSonarArrays = 0xFu << 1,
  kFlagStopButton = 1u << 5,
  kFlagEStall = 1u << 6,
  kFlagFarLedge = 1u << 7,
  kFlagNearLedge = 1u << 8,
  kFlagJoystickButton = 1u << 9,
  kFlagPowerGood = 1u << 10,
};

/// What one sonar heard.
struct SonarReading {
  std::uint8_t number = 0;
  std::uint16_t range_mm = 0;  ///< × RangeConvFactor, 1 on most robots
  friend bool operator==(const SonarReading&, const SonarReading&) = default;
};

/// As many as the longest packet holds after the 20 fixed bytes.
inline constexpr std::size_t kMaxSonarReadings = (kMaxBodySize - 20) / 3;

/// In wire order. A field of the tail is unset when the robot ended its packet before it.
struct Sip {
  std::uint8_t id = kSipStanding;
  std::uint16_t x_pos = 0;  ///< × DistConvFactor → mm; wraps
  std::uint16_t y_pos = 0;
  std::int16_t th_pos = 0;     ///< × 2π/4096 rad, counter-clockwise +
  std::int16_t left_mm_s = 0;  ///< × VelConvFactor, 1 on most robots
  std::int16_t right_mm_s = 0;
  std::uint8_t battery_dv = 0;          ///< 0.1 V
  std::uint16_t stall_and_bumpers = 0;  ///< low byte left and rear, high byte right and front
  std::int16_t control = 0;             ///< heading set point
  std::uint16_t flags = 0;              ///< SipFlag bits
  std::uint8_t compass_2deg = 0;        ///< 2° units
  std::uint8_t sonar_count = 0;         ///< readings in `sonars` that are valid
  std::array<SonarReading, kMaxSonarReadings> sonars{};
  // The tail: a robot may end its packet before any of these; then it sends none of those after it.
  std::optional<std::uint8_t> gripper;
  std::optional<std::uint8_t> ad_port;
  std::optional<std::uint8_t> analog;  ///< 0…255 = 0…5 V
  std::optional<std::uint8_t> digital_in;
  std::optional<std::uint8_t> digital_out;
  std::optional<std::uint16_t> battery_long_dv;  ///< 0.1 V
  std::optional<std::uint8_t> charge_state;      ///< 0 none, 1 bulk, 2 overcharge, 3 float, 4 balance
  std::optional<std::int16_t> rotation_ddeg_s;   ///< 0.1 deg/s
  std::optional<std::uint16_t> fault_flags;

  bool stall_left() const { return (stall_and_bumpers & 0x0001) != 0; }
  bool stall_right() const { return (stall_and_bumpers & 0x0100) != 0; }
  /// Bit i: segment i pressed, seven segments.
  std::uint8_t bumpers_rear() const { return static_cast<std::uint8_t>(stall_and_bumpers >> 1 & 0x7F); }
  std::uint8_t bumpers_front() const { return static_cast<std::uint8_t>(stall_and_bumpers >> 9 & 0x7F); }
  friend bool operator==(const Sip&, const Sip&) = default;
};

/// The inverse of the three accessors above.
constexpr std::uint16_t stall_and_bumpers_word(bool stall_left, bool stall_right, std::uint8_t bumpers_front,
                                               std::uint8_t bumpers_rear) {
  const unsigned low = (stall_left ? 1u : 0u) | (bumpers_rear & 0x7Fu) << 1;
  const unsigned high = (stall_right ? 1u : 0u) | (bumpers_front & 0x7Fu) << 1;
  return static_cast<std::uint16_t>(high << 8 | low);
}

/// Truncated when the body ends before the sonar readings do; tail fields that are not whole are left unset.
DecodeResult decode_sip(std::span<const std::uint8_t> body, Sip& out);
/// Writes the tail up to its first unset field. Empty when there are too many sonar readings for a packet.
Frame encode_sip(const Sip& sip);

}  // namespace arcos
