#include "sim/transport/tcp_transport.h"

#include <fmt/format.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>

#include <cerrno>
#include <cstring>
#include <string_view>
#include <utility>

#include "heel/error.h"

namespace heel::sim {
namespace {

constexpr int kEnabled = 1;
constexpr int kKeepAlive_s = 3;  // of silence before the client's computer is asked, and between questions
constexpr int kKeepAlives = 3;
constexpr int kUnanswered_ms = 10'000;

FileDescriptor listen_on(const addrinfo& place) {
  FileDescriptor listener(
      ::socket(place.ai_family, place.ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC, place.ai_protocol));
  if (!listener.valid()) return listener;
  setsockopt(listener.get(), SOL_SOCKET, SO_REUSEADDR, &kEnabled, sizeof kEnabled);
  const bool listening =
      ::bind(listener.get(), place.ai_addr, place.ai_addrlen) == 0 && ::listen(listener.get(), 4) == 0;
  return listening ? std::move(listener) : FileDescriptor();
}

int port_of(int fd) {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  if (getsockname(fd, reinterpret_cast<sockaddr*>(&address), &size) != 0) return 0;
  return ntohs(address.ss_family == AF_INET6 ? reinterpret_cast<const sockaddr_in6*>(&address)->sin6_port
                                             : reinterpret_cast<const sockaddr_in*>(&address)->sin_port);
}

}  // namespace

TcpTransport::TcpTransport(const std::string& host, int port, std::chrono::milliseconds silent)
    : host_(host), port_(port), silent_(silent) {
  const std::string where = fmt::format("--robot tcp:{}:{}", host, port);
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_PASSIVE | AI_NUMERICSERV;
  addrinfo* found = nullptr;
  if (const int error = getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &found); error != 0) {
    throw Error(
        fmt::format("{}: '{}' is not an address of this machine: {}", where, host, gai_strerror(error)));
  }
  listener_ = listen_on(*found);
  const int error = errno;
  freeaddrinfo(found);
  if (!listener_.valid())
    throw Error(fmt::format("{}: cannot listen: {}{}", where, std::strerror(error),
                            error == EADDRINUSE ? " (by another heel-sim?)" : ""));
  port_ = port_of(listener_.get());
}

/// A connected client of ours, or none. When its computer does not answer for some seconds, the connection
/// ends.
FileDescriptor TcpTransport::accept_one() {
  FileDescriptor client(::accept4(listener_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
  if (!client.valid()) return client;
  const auto set = [&client](int level, int option, int value) {
    setsockopt(client.get(), level, option, &value, sizeof value);
  };
  set(IPPROTO_TCP, TCP_NODELAY, kEnabled);
  set(SOL_SOCKET, SO_KEEPALIVE, kEnabled);
  set(IPPROTO_TCP, TCP_KEEPIDLE, kKeepAlive_s);
  set(IPPROTO_TCP, TCP_KEEPINTVL, kKeepAlive_s);
  set(IPPROTO_TCP, TCP_KEEPCNT, kKeepAlives);
  set(IPPROTO_TCP, TCP_USER_TIMEOUT, kUnanswered_ms);
  return client;
}

void TcpTransport::refuse(const FileDescriptor& client) {
  constexpr std::string_view kWhy = "heel-sim: in use by another client\r\n";
  ::send(client.get(), kWhy.data(), kWhy.size(), MSG_NOSIGNAL);
  ::shutdown(client.get(), SHUT_WR);
  news_.emplace_back("another client refused: one is connected");
}

/// It may have left bytes that are not read yet.
bool TcpTransport::client_has_closed() const {
  pollfd line{client_.get(), POLLRDHUP, 0};
  return ::poll(&line, 1, 0) == 1 && (line.revents & (POLLRDHUP | POLLHUP | POLLERR)) != 0;
}

void TcpTransport::look_at_next_client() {
  if (client_has_closed()) return;  // the next one waits until the last bytes are read
  FileDescriptor other = accept_one();
  if (!other.valid()) return;
  const auto silent = Clock::now() - t_heard_;
  if (silent < silent_) return refuse(other);
  news_.push_back(fmt::format("client let go: it has sent nothing for {} s, and another one has come",
                              std::chrono::duration_cast<std::chrono::seconds>(silent).count()));
  client_.close();
  next_ = std::move(other);
}

bool TcpTransport::client_present() {
  if (client_.valid()) look_at_next_client();
  if (client_.valid()) return true;
  if (client_was_present_) {  // the caller must see that the last client has gone before it sees the next
    client_was_present_ = false;
    return false;
  }
  client_ = next_.valid() ? std::exchange(next_, FileDescriptor()) : accept_one();
  client_was_present_ = client_.valid();
  t_heard_ = Clock::now();
  return client_was_present_;
}

std::string TcpTransport::take_news() {
  if (news_.empty()) return "";
  const std::string first = news_.front();
  news_.pop_front();
  return first;
}

std::size_t TcpTransport::read(std::span<std::uint8_t> into) {
  if (!client_.valid()) return 0;
  const ssize_t size = ::recv(client_.get(), into.data(), into.size(), 0);
  if (size > 0) {
    t_heard_ = Clock::now();
    return static_cast<std::size_t>(size);
  }
  if (size == 0 || (errno != EAGAIN && errno != EINTR)) client_.close();
  return 0;
}

void TcpTransport::write(std::span<const std::uint8_t> bytes) {
  while (client_.valid() && !bytes.empty()) {
    const ssize_t size = ::send(client_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (size <= 0) return;  // no room, or disconnected: the next read finds that out
    bytes = bytes.subspan(static_cast<std::size_t>(size));
  }
}

}  // namespace heel::sim
