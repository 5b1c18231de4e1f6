#include "robot/tcp_connect.h"

#include <fmt/format.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>

namespace heel {
namespace {

/// 0 when connected, else an errno.
int finish_connect(int fd, const addrinfo& to, TimeNs timeout_ns) {
  if (::connect(fd, to.ai_addr, to.ai_addrlen) == 0) return 0;
  if (errno != EINPROGRESS) return errno;
  pollfd entry{fd, POLLOUT, 0};
  if (::poll(&entry, 1, static_cast<int>(timeout_ns / kNsPerMs)) <= 0) return ETIMEDOUT;
  int error = 0;
  socklen_t size = sizeof(error);
  ::getsockopt(fd, SOL_SOCKET, SO_ERROR, &error, &size);
  return error;
}

}  // namespace

int tcp_connect(const std::string& host, std::uint16_t port, TimeNs timeout_ns, std::string& why) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  const int lookup = ::getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &found);
  if (lookup != 0) {
    why = fmt::format("cannot find host '{}': {}", host, ::gai_strerror(lookup));
    return -1;
  }
  const std::unique_ptr<addrinfo, void (*)(addrinfo*)> list(found, ::freeaddrinfo);
  for (const addrinfo* to = list.get(); to != nullptr; to = to->ai_next) {
    const int fd = ::socket(to->ai_family, to->ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC, to->ai_protocol);
    const int error = fd < 0 ? errno : finish_connect(fd, *to, timeout_ns);
    if (error == 0) return fd;
    const char* const cause = error == ECONNREFUSED ? " (nothing listens on that port)"
                              : error == ETIMEDOUT  ? " (nothing answers at that address)"
                                                    : "";
    why = fmt::format("cannot connect: {}{}", std::strerror(error), cause);
    if (fd >= 0) ::close(fd);
  }
  return -1;
}

}  // namespace heel
