// The byte line to the robot: a serial port, a pty or a TCP connection. Only open(), wait_readable() and
// drain() wait; only opening and closing allocate memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "heel/time.h"
#include "robot/robot_address.h"
#include "robot/serial_hints.h"

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

  /// Opens and configures: 8N1, no flow control, raw. May take a few seconds (a host name to look up, a slow
  /// device). False: error() holds one line.
  bool open(const RobotAddress& address, int baud);
  /// Output that has not been sent is dropped. On TCP this does nothing and returns true.
  bool set_baud(int baud);
  /// Drops output that still waits in a serial driver; call drain() before to send it.
  void close();

  bool is_open() const { return fd_ >= 0; }
  const std::string& error() const { return error_; }
  /// What a person should know of the last successful open(): the adapter has another name now. Empty:
  /// nothing.
  const std::string& note() const { return note_; }

  /// Waits for input, at most `timeout_ns`. True: read() will return some, or Lost. A terminal is looked at
  /// every 2 ms, so the answer may come so much later than the input.
  bool wait_readable(TimeNs timeout_ns) const;
  /// Reads what has arrived, which may be nothing.
  Transfer read(std::span<std::uint8_t> into);
  /// Writes what the driver accepts, which may be nothing.
  Transfer write(std::span<const std::uint8_t> bytes);
  /// Bytes that the driver has accepted and not yet sent.
  std::size_t unsent_bytes() const;
  /// Waits until everything has been sent, at most `timeout_ns`. False: not everything.
  bool drain(TimeNs timeout_ns) const;

 private:
  int bytes_in_terminal() const;
  bool open_serial(const RobotAddress& address, int baud);
  std::string find_device(const std::string& path);
  bool open_pty(const RobotAddress& address, int baud);
  bool configure_pty(int baud);
  bool open_tcp(const RobotAddress& address);
  bool fail(const std::string& why);
  bool claim(const std::string& device);

  RobotAddress::Kind kind_ = RobotAddress::Kind::Serial;
  std::string name_;  ///< the address, for errors
  int fd_ = -1;
  sp_port* port_ = nullptr;  ///< serial ports only; it then owns fd_
  std::string error_;
  std::string note_;
  std::optional<UsbAdapter> adapter_;  ///< of the port that was open last
};

}  // namespace heel
