#include "operator/mqtt/paho/reachable.h"

#include <fmt/format.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>

#include "heel/time.h"

namespace heel {
namespace {

// The MQTT library has waited long enough already.
constexpr TimeNs kLook_ns = 500 * kNsPerMs;

/// 0 when connected, else an errno.
int try_to_connect(const addrinfo& to) {
  const int fd = socket(to.ai_family, to.ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC, to.ai_protocol);
  if (fd < 0) return errno;
  int error = connect(fd, to.ai_addr, to.ai_addrlen) == 0 ? 0 : errno;
  if (error == EINPROGRESS) {
    pollfd entry{fd, POLLOUT, 0};
    socklen_t size = sizeof(error);
    if (poll(&entry, 1, static_cast<int>(kLook_ns / kNsPerMs)) <= 0) {
      error = ETIMEDOUT;
    } else {
      getsockopt(fd, SOL_SOCKET, SO_ERROR, &error, &size);
    }
  }
  close(fd);
  return error;
}

}  // namespace

std::string why_unreachable(const std::string& address) {
  const std::size_t begin = address.find("://") + 3, colon = address.rfind(':');
  std::string host = address.substr(begin, colon - begin);
  if (host.starts_with('[')) host = host.substr(1, host.size() - 2);
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  const int lookup = getaddrinfo(host.c_str(), address.c_str() + colon + 1, &hints, &found);
  if (lookup != 0) return fmt::format("the host is not found: {}", gai_strerror(lookup));
  const std::unique_ptr<addrinfo, void (*)(addrinfo*)> list(found, freeaddrinfo);
  int error = 0;
  for (const addrinfo* to = list.get(); to != nullptr; to = to->ai_next) {
    error = try_to_connect(*to);
    if (error == 0) return "";
  }
  const char* const cause = error == ECONNREFUSED ? " (no program listens on that port)" : "";
  return fmt::format("cannot be reached: {}{}", std::strerror(error), cause);
}

}  // namespace heel
