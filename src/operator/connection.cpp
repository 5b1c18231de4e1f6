#include "operator/connection.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <utility>

namespace heel {
namespace {

constexpr std::size_t kReadBytes = 4096;
constexpr std::size_t kSocketBytes = 256 * 1024;  // more than net.core.wmem_default

std::string peer_of(int fd) {
  ucred peer{};
  socklen_t size = sizeof peer;
  if (getsockopt(fd, SOL_SOCKET, SO_PEERCRED, &peer, &size) != 0) return "unknown user";
  return fmt::format("user {}, process {}", peer.uid, peer.pid);
}

}  // namespace

bool RateLimit::allow(TimeNs now_ns) {
  if (t_last_ns_ != 0) left_ = std::min(per_s_, left_ + per_s_ * seconds_from_ns(now_ns - t_last_ns_));
  t_last_ns_ = now_ns;
  if (left_ < 1.0) return false;
  left_ -= 1.0;
  return true;
}

Connection::Connection(int fd, std::uint64_t number, TimeNs now_ns)
    : Connection(fd, number, now_ns, peer_of(fd), nullptr) {}

Connection::Connection(int fd, std::uint64_t number, TimeNs now_ns, std::string who, MayWrite may_write)
    : t_active_ns(now_ns), fd_(fd), number_(number), who_(std::move(who)), may_write_(std::move(may_write)) {}

Connection::~Connection() {
  close(fd_);
}

bool Connection::read() {
  std::array<char, kReadBytes> bytes;
  const ssize_t count = recv(fd_, bytes.data(), bytes.size(), MSG_DONTWAIT);
  if (count > 0) {
    in_.feed({bytes.data(), static_cast<std::size_t>(count)});
  } else if (count == 0) {
    input_ended_ = true;
  } else if (errno != EAGAIN && errno != EINTR) {
    broken_ = true;
  }
  return count > 0;
}

void Connection::read_all() {
  for (std::size_t count = 0; count < kSocketBytes && read(); count += kReadBytes) {
  }
}

bool Connection::take_partial_end() {
  if (!input_ended_ || partial_reported_ || !in_.has_partial_line()) return false;
  partial_reported_ = true;
  return true;
}

bool Connection::peer_gone() const {
  pollfd end{fd_, 0, 0};
  return poll(&end, 1, 0) > 0 && (end.revents & (POLLHUP | POLLERR)) != 0;
}

void Connection::send_line(std::string_view line) {
  if (broken_) return;
  out_.append(line).push_back('\n');
  flush();
  if (out_.size() > kMaxWaitingBytes) broken_ = true;
}

void Connection::flush() {
  while (!broken_ && !out_.empty()) {
    const ssize_t count = send(fd_, out_.data(), out_.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0 && errno == EAGAIN) return;
    if (count < 0) {
      broken_ = true;
      return;
    }
    out_.erase(0, static_cast<std::size_t>(count));
  }
}

}  // namespace heel
