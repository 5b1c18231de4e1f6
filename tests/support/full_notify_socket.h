// A notification socket (sd_notify(3)) that is full from the start, and that only the test reads.
#pragma once

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

namespace heel::test {

class FullNotifySocket {
 public:
  /// `name`: an absolute path, or @ and a name of the abstract namespace, as in NOTIFY_SOCKET.
  explicit FullNotifySocket(const std::string& name) : name_(name) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    name.copy(address.sun_path, sizeof address.sun_path - 1);
    if (name.front() == '@') address.sun_path[0] = '\0';
    const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + name.size());
    const auto* const generic = reinterpret_cast<const sockaddr*>(&address);
    fd_ = socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    if (bind(fd_, generic, size) != 0) throw std::runtime_error("cannot bind " + name);
    const int sender = socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    while (sendto(sender, kFiller, 1, 0, generic, size) == 1) {
    }
    close(sender);
  }
  ~FullNotifySocket() { close(fd_); }
  FullNotifySocket(const FullNotifySocket&) = delete;
  FullNotifySocket& operator=(const FullNotifySocket&) = delete;

  const std::string& name() const { return name_; }

  /// Empties the socket: the messages that others have sent since the last call, in order.
  std::vector<std::string> take() {
    std::vector<std::string> messages;
    char text[4096];
    for (ssize_t size; (size = recv(fd_, text, sizeof text, 0)) > 0;) {
      if (size > 1) messages.emplace_back(text, static_cast<std::size_t>(size));
    }
    return messages;
  }

 private:
  static constexpr const char* kFiller = "x";  // shorter than any message
  std::string name_;
  int fd_ = -1;
};

}  // namespace heel::test
