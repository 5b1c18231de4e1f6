// A TCP port for one client at a time, as a robot has one line. Another client is told so and refused. A
// client that is half dead is let go: one whose computer does not answer any more, after some seconds, and
// one that has said nothing for longer than any ARCOS client does, when another one comes.
#pragma once

#include <chrono>
#include <deque>

#include "sim/transport/file_descriptor.h"
#include "sim/transport/transport.h"

namespace heel::sim {

class TcpTransport : public Transport {
 public:
  /// The robot's watchdog is 2 s; a client that drives, or only wants to stay, sends more often than this.
  static constexpr std::chrono::seconds kSilent{8};

  /// Starts to listen; throws heel::Error when it cannot. Port 0 takes a free one. A
  /// client that was silent for longer than `silent` gives way to another one.
  TcpTransport(const std::string& host, int port, std::chrono::milliseconds silent = kSilent);

  bool client_present() override;
  std::size_t read(std::span<std::uint8_t> into) override;
  void write(std::span<const std::uint8_t> bytes) override;
  std::string take_news() override;
  std::string address() const override { return "tcp:" + host_ + ":" + std::to_string(port_); }
  int port() const { return port_; }

 private:
  using Clock = std::chrono::steady_clock;

  FileDescriptor accept_one();
  bool client_has_closed() const;
  void look_at_next_client();
  void refuse(const FileDescriptor& client);

  std::string host_;
  int port_;
  FileDescriptor listener_;
  FileDescriptor client_;
  FileDescriptor next_;  ///< accepted in place of `client_`, which is half dead
  bool client_was_present_ = false;
  std::chrono::milliseconds silent_;
  Clock::time_point t_heard_;  ///< when `client_` last sent something
  std::deque<std::string> news_;
};

}  // namespace heel::sim
