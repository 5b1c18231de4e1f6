// A tiny ARCOS client that shares no code with heel: bytes built by hand, a parser of its own.
#pragma once

#include <termios.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

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
  /// "pty:PATH" or "tcp:HOST:PORT", as heel-sim announces itself.
  static RawClient at(const std::string& address);
  RawClient(RawClient&& other) noexcept : fd_(other.fd_) { other.fd_ = -1; }
  RawClient(const RawClient&) = delete;
  RawClient& operator=(const RawClient&) = delete;
  ~RawClient() { hang_up(); }

  void hang_up();
  /// The terminal's rate, as a client of a serial port sets it.
  void set_rate(speed_t rate) const;
  void send(const Bytes& bytes) const;
  void send(int id) const { send(framed({static_cast<std::uint8_t>(id)})); }
  void send(int id, int argument) const { send(command(id, argument)); }

  /// Reads for this long; bodies of good packets go to `packets`.
  void listen(double seconds);
  /// Reads until a packet with one of these ids comes; its body, or empty after the timeout.
  Bytes wait_for(const std::vector<int>& ids, double timeout_s = 3.0);
  /// SYNC0…SYNC2, each sent again every 0.5 s; false when an echo is missing after 4 s.
  bool sync();

  std::vector<Bytes> packets;
  Bytes raw;  ///< everything read

 private:
  explicit RawClient(int fd) : fd_(fd) {}
  bool read_some(double timeout_s);
  void parse();

  int fd_ = -1;
  Bytes unparsed_;
};

int i16_at(const Bytes& body, std::size_t offset);

}  // namespace heel::test
