// One byte line to the robot: a serial port, a pty or a TCP connection. After opening, nothing here blocks,
// and nothing allocates but opening and closing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "heel/time.h"
#include "robot/robot_address.h"

struct sp_port;

namespace heel {

class SerialLine {
 public:
  enum class Status : std::uint8_t { Ok, Lost };
  struct Transfer {
    std::size_t count = 0;
    Status status = Status::Ok;
  };

  SerialLine() = default;
  ~SerialLine() { close(); }
  SerialLine(const SerialLine&) = delete;
  SerialLine& operator=(const SerialLine&) = delete;

  /// Opens and configures: 8N1, no flow control, raw. May take long (a name to look up, a device to wake), at
  /// most a few seconds. False with a line for people in error().
  bool open(const RobotAddress& address, int baud);
  /// Nothing to set on TCP: true. What has not gone out yet is dropped.
  bool set_baud(int baud);
  /// At once: output still waiting in a serial driver is dropped. See drain().
  void close();

  bool is_open() const { return fd_ >= 0; }
  const std::string& error() const { return error_; }

  /// Waits until there is something to read, or for `timeout_ns`. True: read now.
  bool wait_readable(TimeNs timeout_ns) const;
  /// What is there, possibly nothing.
  Transfer read(std::span<std::uint8_t> into);
  /// What the driver takes, possibly nothing.
  Transfer write(std::span<const std::uint8_t> bytes);
  /// Bytes taken by the driver and not yet gone out.
  std::size_t unsent_bytes() const;
  /// Waits until all has gone out, for `timeout_ns` at most.
  bool drain(TimeNs timeout_ns) const;

 private:
  bool open_serial(const RobotAddress& address, int baud);
  bool open_pty(const RobotAddress& address, int baud);
  bool configure_pty(int baud);
  bool open_tcp(const RobotAddress& address);
  bool fail(const std::string& why);

  RobotAddress::Kind kind_ = RobotAddress::Kind::Serial;
  std::string name_;  ///< the address, for messages
  int fd_ = -1;
  sp_port* port_ = nullptr;  ///< serial only; owns fd_ then
  std::string error_;
};

}  // namespace heel
