// The address of the robot's controller: serial:/dev/ttyUSB0@38400, pty:PATH@38400 or tcp:HOST:PORT. A pty
// stands for a serial line: it has a rate, and the robot simulated behind it understands no other rate.
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace heel {

/// The rates of an ARCOS controller, in the order of HOSTBAUD.
inline constexpr std::array<int, 5> kRobotBauds = {9600, 19200, 38400, 57600, 115200};
/// For an address without a rate; enough for both velocities in each tick.
inline constexpr int kDefaultBaud = 38400;

struct RobotAddress {
  enum class Kind : std::uint8_t { Serial, Pty, Tcp };
  Kind kind = Kind::Serial;
  std::string text;         ///< the address as configured, for errors
  std::string path;         ///< serial and pty
  int baud = kDefaultBaud;  ///< serial and pty: tried first
  std::string host;         ///< tcp
  std::uint16_t port = 0;
};

/// Throws heel::Error, which names the address, the wrong part and what was expected.
RobotAddress parse_robot_address(const std::string& text);

}  // namespace heel
