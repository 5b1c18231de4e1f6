// Where the robot's controller is: serial:/dev/ttyUSB0@38400, pty:PATH@38400 or tcp:HOST:PORT. A pty stands
// for a serial line: it has a rate, and a robot simulated behind it understands no other.
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace heel {

/// The rates an ARCOS controller knows, in HOSTBAUD's order.
inline constexpr std::array<int, 5> kRobotBauds = {9600, 19200, 38400, 57600, 115200};
/// Where the address names none: carries both velocities in each tick with room to spare.
inline constexpr int kDefaultBaud = 38400;

struct RobotAddress {
  enum class Kind : std::uint8_t { Serial, Pty, Tcp };
  Kind kind = Kind::Serial;
  std::string text;         ///< as it was given, for messages
  std::string path;         ///< serial and pty
  int baud = kDefaultBaud;  ///< serial and pty: tried first
  std::string host;         ///< tcp
  std::uint16_t port = 0;
};

/// Throws heel::Error naming the address, the part that is wrong and what was expected.
RobotAddress parse_robot_address(const std::string& text);

}  // namespace heel
