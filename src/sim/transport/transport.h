// The robot's end of a line to a client that comes and goes: a pseudo-terminal or a TCP port. Nothing blocks.
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

  /// Looks whether a client is there, lets the next one in when the last has gone.
  virtual bool client_present() = 0;
  /// What the client has sent, at most `into.size()` bytes; 0: nothing now.
  virtual std::size_t read(std::span<std::uint8_t> into) = 0;
  /// What the client has no room for is lost, as on a serial line.
  virtual void write(std::span<const std::uint8_t> bytes) = 0;
  /// The rate the client has set its end to, bit/s; 0: this line has no rate.
  virtual int host_baud() const { return 0; }
  /// Where a client finds it, e.g. "pty:/tmp/robot".
  virtual std::string address() const = 0;
};

/// `spec`: "pty:PATH", "tcp:PORT" (on 127.0.0.1) or "tcp:HOST:PORT"; port 0 takes a free one. A new pty's
/// rate is `boot_baud`. Throws heel::Error naming what is wrong.
std::unique_ptr<Transport> open_transport(const std::string& spec, int boot_baud);

}  // namespace heel::sim
