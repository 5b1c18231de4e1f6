// A small ARCOS client that shares no code with heel: it frames and parses packets itself.
#pragma once

#include <termios.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "support/process.h"

namespace heel::test {

using Bytes = std::vector<std::uint8_t>;

/// FA FB, count, body, checksum.
Bytes framed(const Bytes& body);
/// A command with a 16-bit argument, negative ones as 1B and the magnitude.
Bytes command(int id, int argument);

class RawClient {
 public:
  static RawClient on_pty(const std::string& path);
  static RawClient on_tcp(int port);
  /// "pty:PATH" or "tcp:HOST:PORT", the address that heel-sim prints.
  static RawClient at(const std::string& address);
  RawClient(RawClient&& other) noexcept : fd_(other.fd_) { other.fd_ = -1; }
  RawClient(const RawClient&) = delete;
  RawClient& operator=(const RawClient&) = delete;
  ~RawClient() { hang_up(); }

  void hang_up();
  /// Reads until the other end closes; false when it has not within the time.
  bool is_hung_up_on(double timeout_s = kPatience_s);
  /// The terminal's rate, as a client of a serial port sets it.
  void set_rate(speed_t rate) const;
  void send(const Bytes& bytes) const;
  void send(int id) const { send(framed({static_cast<std::uint8_t>(id)})); }
  void send(int id, int argument) const { send(command(id, argument)); }

  /// Reads for this long, and then the bytes that are waiting; bodies of good packets go to `packets`.
  void listen(double seconds);
  /// Reads until a good packet comes whose body satisfies `wanted`; that body, or empty after the timeout.
  Bytes wait_for(const std::function<bool(const Bytes&)>& wanted, double timeout_s = kPatience_s);
  /// The next SIP, with any of its ids.
  Bytes next_sip(double timeout_s = kPatience_s);
  /// SYNC0…SYNC2, each sent again every 0.5 s; false when an echo is missing.
  bool sync();
  /// Reads until half a second passes without a byte; false when bytes come again and again.
  bool falls_silent();

  std::vector<Bytes> packets;
  Bytes raw;  ///< everything read

 private:
  explicit RawClient(int fd) : fd_(fd) {}
  bool read_some(double timeout_s);
  void parse();

  int fd_ = -1;
  Bytes unparsed_;
};

bool is_sip(const Bytes& body);
bool is_moving_sip(const Bytes& body);
int i16_at(const Bytes& body, std::size_t offset);

}  // namespace heel::test
