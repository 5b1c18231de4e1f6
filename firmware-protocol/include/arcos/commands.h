/// \file
/// The one table of client commands: id, name, argument and meaning.
///
/// - Units: each command's meaning names its own.
/// - Source: MobileRobots Inc., "Pioneer 3 Operations Manual", 2006, chapter on ARCOS, client command
///   packets.
#pragma once

#include <cstdint>
#include <span>

namespace arcos {

/// Ids 0…2 mean SYNC0…SYNC2 before the connection is open, PULSE, OPEN and CLOSE after it.
enum class CommandId : std::uint8_t {
  Sync0 = 0,
  Sync1 = 1,
  Sync2 = 2,
  Pulse = 0,
  Open = 1,
  Close = 2,
  Polling = 3,
  Enable = 4,
  SetA = 5,
  SetV = 6,
  SetO = 7,
  Move = 8,
  Rotate = 9,
  SetRv = 10,
  Vel = 11,
  Head = 12,
  DHead = 13,
  Say = 15,
  JoyRequest = 17,
  Config = 18,
  Encoder = 19,
  RVel = 21,
  DcHead = 22,
  SetRa = 23,
  Sonar = 28,
  Stop = 29,
  DigOut = 30,
  Vel2 = 32,
  AdSel = 35,
  IoRequest = 40,
  Tty2 = 42,
  GetAux = 43,
  BumpStall = 44,
  SonarCycle = 48,
  HostBaud = 50,
  EStop = 55,
  EStall = 56,
  Gyro = 58,
  BatteryInfo = 62,
  RotKp = 82,
  RotKv = 83,
  RotKi = 84,
  TransKp = 85,
  TransKv = 86,
  TransKi = 87,
  RevCount = 88,
  DriftFactor = 89,
  SoundTog = 92,
  TicksMm = 93,
  BatTest = 250,
  Reset = 253,
  Maintenance = 255,
};

/// Which argument a command takes.
enum class ArgumentKind : std::uint8_t {
  None,
  OptionalInteger,  ///< clients differ: none, or a non-negative integer
  Integer,          ///< non-negative
  SignedInteger,    ///< negative goes as 1B and the magnitude
  Text,             ///< 2B, length, bytes
  TwoBytes,         ///< one word of two separate bytes
};

/// A row of the table.
struct CommandInfo {
  CommandId id;
  const char* name;
  ArgumentKind argument;
  bool may_be_sent;  ///< false: this library refuses to encode it
  const char* meaning;
};

/// Ordered by id.
std::span<const CommandInfo> command_table();

/// The row of a command; nullptr when the table has none.
const CommandInfo* find_command(std::uint8_t id);
inline const CommandInfo* find_command(CommandId id) {
  return find_command(static_cast<std::uint8_t>(id));
}

}  // namespace arcos
