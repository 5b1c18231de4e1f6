// A TCP port for one client at a time; the next client waits until the last has disconnected.
#pragma once

#include "sim/transport/file_descriptor.h"
#include "sim/transport/transport.h"

namespace heel::sim {

class TcpTransport : public Transport {
 public:
  /// Starts to listen; throws heel::Error when it cannot. Port 0 takes a free one.
  TcpTransport(const std::string& host, int port);

  bool client_present() override;
  std::size_t read(std::span<std::uint8_t> into) override;
  void write(std::span<const std::uint8_t> bytes) override;
  std::string address() const override { return "tcp:" + host_ + ":" + std::to_string(port_); }
  int port() const { return port_; }

 private:
  std::string host_;
  int port_;
  FileDescriptor listener_;
  FileDescriptor client_;
  bool client_was_present_ = false;
};

}  // namespace heel::sim
