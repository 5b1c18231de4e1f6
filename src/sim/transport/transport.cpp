#include "sim/transport/transport.h"

#include <fmt/format.h>

#include <charconv>

#include "heel/error.h"
#include "sim/transport/pty_transport.h"
#include "sim/transport/tcp_transport.h"

namespace heel::sim {
namespace {

int port_of(const std::string& text, const std::string& address) {
  int port = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), port);
  if (error != std::errc{} || end != text.data() + text.size() || port < 0 || port > 65535) {
    throw Error(fmt::format("--robot {}: '{}' is not a port (expected 0…65535)", address, text));
  }
  return port;
}

}  // namespace

std::unique_ptr<Transport> open_transport(const std::string& address, int boot_baud) {
  if (address.starts_with("pty:") && address.size() > 4) {
    return std::make_unique<PtyTransport>(address.substr(4), boot_baud);
  }
  if (address.starts_with("tcp:")) {
    const std::string rest = address.substr(4);
    const std::size_t colon = rest.rfind(':');
    const std::string host = colon == std::string::npos ? "127.0.0.1" : rest.substr(0, colon);
    return std::make_unique<TcpTransport>(host, port_of(rest.substr(colon + 1), address));
  }
  throw Error(
      fmt::format("--robot {}: not an address (expected pty:PATH, tcp:PORT or tcp:HOST:PORT)", address));
}

}  // namespace heel::sim
