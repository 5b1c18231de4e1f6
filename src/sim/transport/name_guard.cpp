#include "sim/transport/name_guard.h"

#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/un.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <functional>
#include <string>

#include "heel/error.h"

namespace heel::sim {
namespace {

/// Short whatever the length of the name is; the first byte stays zero: an abstract address.
sockaddr_un address_of(const std::string& name, socklen_t& size) {
  const std::string text = fmt::format("heel-sim-{:016x}", std::hash<std::string>{}(name));
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::copy(text.begin(), text.end(), address.sun_path + 1);
  size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + text.size());
  return address;
}

/// Of the process that listens at the address; 0: it cannot be asked.
int pid_at(const sockaddr_un& address, socklen_t size) {
  const FileDescriptor probe(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (::connect(probe.get(), reinterpret_cast<const sockaddr*>(&address), size) != 0) return 0;
  ucred peer{};
  socklen_t peer_size = sizeof peer;
  if (::getsockopt(probe.get(), SOL_SOCKET, SO_PEERCRED, &peer, &peer_size) != 0) return 0;
  return peer.pid;
}

}  // namespace

NameGuard::NameGuard(const std::string& name, const std::string& what)
    : socket_(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {
  socklen_t size = 0;
  const sockaddr_un address = address_of(name, size);
  if (::bind(socket_.get(), reinterpret_cast<const sockaddr*>(&address), size) == 0) {
    ::listen(socket_.get(), 1);
    return;
  }
  if (errno != EADDRINUSE) throw Error(fmt::format("{}: cannot be held: {}", what, std::strerror(errno)));
  const int pid = pid_at(address, size);
  const std::string who = pid > 0 ? fmt::format(" (process {})", pid) : "";
  throw Error(
      fmt::format("{}: another heel-sim{} serves it; stop it first, or choose another path", what, who));
}

}  // namespace heel::sim
