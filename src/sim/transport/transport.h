// The robot's end of a line to clients that connect and disconnect: a pseudo-terminal or a TCP port. No call
// blocks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace heel::sim {

class Transport {
 public:
  virtual ~Transport() = default;

  /// Whether a client is connected; accepts the next one when the last has gone.
  virtual bool client_present() = 0;
  /// Reads what the client has sent and returns the number of bytes; 0: nothing now.
  virtual std::size_t read(std::span<std::uint8_t> into) = 0;
  /// Bytes that the client's buffer has no room for are lost, as on a serial line.
  virtual void write(std::span<const std::uint8_t> bytes) = 0;
  /// The rate the client has set its end to, bit/s; 0: this line has no rate.
  virtual int host_baud() const { return 0; }
  /// What a person should know, a line for each call, oldest first; empty: nothing more.
  virtual std::string take_news() { return ""; }
  /// The address for clients, e.g. "pty:/tmp/robot".
  virtual std::string address() const = 0;
};

/// `address`: "pty:PATH", "tcp:PORT" (on 127.0.0.1) or "tcp:HOST:PORT"; port 0 takes a free one. A new pty's
/// rate is `boot_baud`. Throws heel::Error naming what is wrong.
std::unique_ptr<Transport> open_transport(const std::string& address, int boot_baud);

}  // namespace heel::sim
