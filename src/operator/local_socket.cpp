#include "operator/local_socket.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "heel/error.h"

namespace heel {
namespace {

constexpr int kBacklog = 16;
constexpr mode_t kMode = 0660;  // the user and the group that heeld runs under

Error socket_error(const std::string& path, const std::string& what) {
  return Error(fmt::format("operator.socket: {}: {}", path, what));
}

/// The address of the socket. Throws when the name does not fit.
sockaddr_un address_of(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path)
    throw socket_error(path, fmt::format("a name of {} bytes (expected at most {})", path.size(),
                                         sizeof address.sun_path - 1));
  path.copy(address.sun_path, path.size());
  return address;
}

const sockaddr* generic(const sockaddr_un& address) {
  return reinterpret_cast<const sockaddr*>(&address);
}

/// Removes the socket of a process that is gone. Throws when a process serves it, or when it is no socket.
void remove_stale_socket(const std::string& path, const sockaddr_un& address) {
  struct stat status {};
  if (lstat(path.c_str(), &status) != 0) return;
  if (!S_ISSOCK(status.st_mode))
    throw socket_error(path, "exists and is no socket (expected a name that is free, or a socket)");
  const int fd = socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (fd < 0) throw socket_error(path, std::strerror(errno));
  const int error = connect(fd, generic(address), sizeof address) != 0 ? errno : 0;
  close(fd);
  if (error == EACCES) {
    throw socket_error(path, fmt::format("permission denied: it belongs to user {} (expected a socket that "
                                         "user {} may use, or a name that is free)",
                                         status.st_uid, geteuid()));
  }
  if (error != ECONNREFUSED)
    throw socket_error(path, "another process serves it (is heeld running already? systemctl status heeld)");
  unlink(path.c_str());
}

}  // namespace

LocalSocket::LocalSocket(const std::string& path) : path_(path) {
  const sockaddr_un address = address_of(path);
  remove_stale_socket(path, address);
  fd_ = socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (fd_ < 0) throw socket_error(path, std::strerror(errno));
  try {
    bind_and_listen();
  } catch (...) {
    close(fd_);
    throw;
  }
}

/// The permissions are set before it listens: until then nobody can connect.
void LocalSocket::bind_and_listen() {
  const sockaddr_un address = address_of(path_);
  if (bind(fd_, generic(address), sizeof address) != 0) {
    throw socket_error(path_,
                       fmt::format("cannot be made: {} (expected a folder that exists and can be written; "
                                   "the service's is /run/heel)",
                                   std::strerror(errno)));
  }
  struct stat status {};
  if (chmod(path_.c_str(), kMode) != 0 || stat(path_.c_str(), &status) != 0 || listen(fd_, kBacklog) != 0) {
    const int error = errno;
    unlink(path_.c_str());
    throw socket_error(path_, fmt::format("cannot be served: {}", std::strerror(error)));
  }
  device_ = status.st_dev;
  inode_ = status.st_ino;
}

int LocalSocket::accept(TimeNs now_ns) {
  if (pauses(now_ns)) return -1;
  const int fd = accept4(fd_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
  if (fd >= 0) {
    warned_ = false;
    return fd;
  }
  if (errno == EAGAIN || errno == EINTR || errno == ECONNABORTED) return -1;
  // The client still waits: without the pause the thread would try again at once, for ever.
  t_accept_ns_ = now_ns + kAcceptPause_ns;
  if (!warned_)
    spdlog::warn("{}: no client can be accepted: {}; heeld tries again", path_, std::strerror(errno));
  warned_ = true;
  return -1;
}

LocalSocket::LocalSocket(LocalSocket&& other) noexcept
    : path_(other.path_),
      fd_(std::exchange(other.fd_, -1)),
      device_(other.device_),
      inode_(other.inode_),
      t_accept_ns_(other.t_accept_ns_),
      warned_(other.warned_) {}

LocalSocket::~LocalSocket() {
  if (fd_ < 0) return;  // moved
  struct stat status {};
  const bool ours = stat(path_.c_str(), &status) == 0 && status.st_dev == device_ && status.st_ino == inode_;
  if (ours) unlink(path_.c_str());
  close(fd_);
}

}  // namespace heel
