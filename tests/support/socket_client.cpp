#include "support/socket_client.h"

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace heel::test {

SocketClient::SocketClient(const std::string& path) : fd_(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  path.copy(address.sun_path, sizeof address.sun_path - 1);
  if (connect(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    close(fd_);
    throw std::runtime_error(path + ": " + std::strerror(errno));
  }
}

SocketClient::~SocketClient() {
  close(fd_);
}

bool SocketClient::send(const std::string& bytes) const {
  return ::send(fd_, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT) ==
         static_cast<ssize_t>(bytes.size());
}

void SocketClient::end_output() const {
  shutdown(fd_, SHUT_WR);
}

bool SocketClient::read_more(double timeout_s) {
  pollfd readable{fd_, POLLIN, 0};
  if (closed_ || poll(&readable, 1, static_cast<int>(1000.0 * timeout_s)) <= 0) return false;
  std::array<char, 4096> bytes;
  const ssize_t count = recv(fd_, bytes.data(), bytes.size(), 0);
  closed_ = count <= 0;
  if (!closed_) waiting_.append(bytes.data(), static_cast<std::size_t>(count));
  return !closed_;
}

std::string SocketClient::line(double timeout_s) {
  const double end_s = monotonic_s() + timeout_s;
  for (;;) {
    const std::size_t newline = waiting_.find('\n');
    if (newline != std::string::npos) {
      std::string text = waiting_.substr(0, newline);
      waiting_.erase(0, newline + 1);
      return text;
    }
    const double left_s = end_s - monotonic_s();
    if (left_s < 0.0 || !read_more(left_s)) return "";
  }
}

bool SocketClient::closed(double timeout_s) {
  const double end_s = monotonic_s() + timeout_s;
  while (!closed_ && monotonic_s() < end_s) read_more(end_s - monotonic_s());
  return closed_;
}

}  // namespace heel::test
