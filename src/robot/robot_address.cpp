#include "robot/robot_address.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string_view>

#include "heel/error.h"

namespace heel {
namespace {

[[noreturn]] void refuse(const std::string& address, const std::string& why) {
  throw Error(fmt::format("robot address '{}': {}", address, why));
}

/// A non-negative whole number, or −1.
int number_of(std::string_view text) {
  int value = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() ? value : -1;
}

/// Where a rate begins that is written as other programs want it, DEVICE:BAUD or DEVICE,BAUD; npos: nowhere.
std::size_t rate_after_other_sign(std::string_view rest) {
  const auto sign = rest.find_last_of(":,");
  if (sign == std::string_view::npos) return sign;
  const bool is_rate = std::find(kRobotBauds.begin(), kRobotBauds.end(), number_of(rest.substr(sign + 1))) !=
                       kRobotBauds.end();
  return is_rate ? sign + 1 : std::string_view::npos;
}

/// PATH or PATH@BAUD.
void parse_line(std::string_view rest, RobotAddress& address) {
  if (const auto rate = rate_after_other_sign(rest); rate != std::string_view::npos)
    refuse(address.text, fmt::format("expected @{} for the rate", rest.substr(rate)));
  const auto at = rest.rfind('@');
  address.path = rest.substr(0, at);
  if (at == std::string_view::npos) return;
  address.baud = number_of(rest.substr(at + 1));
  if (std::find(kRobotBauds.begin(), kRobotBauds.end(), address.baud) == kRobotBauds.end()) {
    refuse(address.text,
           fmt::format("'{}' is not a baud rate of the robot (expected 9600, 19200, 38400, 57600 or 115200)",
                       rest.substr(at + 1)));
  }
}

void parse_tcp(std::string_view rest, RobotAddress& address) {
  if (rest.starts_with("//")) refuse(address.text, "'//' is not needed (expected tcp:HOST:PORT)");
  const auto colon = rest.rfind(':');
  if (colon == std::string_view::npos) refuse(address.text, "no port (expected tcp:HOST:PORT)");
  address.host = rest.substr(0, colon);
  if (address.host.size() > 2 && address.host.front() == '[' && address.host.back() == ']') {
    address.host = address.host.substr(1, address.host.size() - 2);  // an IPv6 address
  }
  if (address.host.empty()) refuse(address.text, "no host (expected tcp:HOST:PORT)");
  if (address.host.find_first_of(" \t") != std::string::npos)
    refuse(address.text, "a space in the host's name (expected tcp:HOST:PORT)");
  const int port = number_of(rest.substr(colon + 1));
  if (port < 1 || port > 65535) {
    refuse(address.text, fmt::format("'{}' is not a port (expected 1…65535)", rest.substr(colon + 1)));
  }
  address.port = static_cast<std::uint16_t>(port);
}

}  // namespace

RobotAddress parse_robot_address(const std::string& text) {
  RobotAddress address;
  address.text = text;
  if (text.starts_with(' ') || text.ends_with(' ')) refuse(text, "a space at an end of it (expected none)");
  const auto colon = text.find(':');
  const std::string_view scheme = std::string_view(text).substr(0, colon);
  const std::string_view rest =
      colon == std::string::npos ? std::string_view() : std::string_view(text).substr(colon + 1);
  if (scheme == "serial" && colon != std::string::npos) {
    address.kind = RobotAddress::Kind::Serial;
    parse_line(rest, address);
  } else if (scheme == "pty" && colon != std::string::npos) {
    address.kind = RobotAddress::Kind::Pty;
    parse_line(rest, address);
  } else if (scheme == "tcp" && colon != std::string::npos) {
    address.kind = RobotAddress::Kind::Tcp;
    parse_tcp(rest, address);
  } else {
    refuse(text, "expected serial:DEVICE@BAUD, pty:PATH@BAUD or tcp:HOST:PORT");
  }
  if (address.kind != RobotAddress::Kind::Tcp && address.path.empty()) {
    refuse(text, fmt::format("no device (expected a path after '{}:')", scheme));
  }
  return address;
}

}  // namespace heel
