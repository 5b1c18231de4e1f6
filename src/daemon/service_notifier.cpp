#include "daemon/service_notifier.h"

#include <spdlog/spdlog.h>
#include <systemd/sd-daemon.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <utility>

namespace heel {
namespace {

// Two reloads (RELOADING and READY each), READY and STOPPING. There are more only while systemd does not
// read; the newest then matter.
constexpr std::size_t kMaxKept = 6;

/// Writes the address that a NOTIFY_SOCKET names, and returns its size; 0 where it names no Unix socket.
socklen_t parse_address(std::string_view name, sockaddr_un& address) {
  address.sun_family = AF_UNIX;
  if (name.size() < 2 || name.size() >= sizeof address.sun_path) return 0;
  if (name.front() != '/' && name.front() != '@') return 0;
  name.copy(address.sun_path, name.size());
  if (name.front() == '@') address.sun_path[0] = '\0';  // how the kernel marks an abstract name
  return static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + name.size());
}

}  // namespace

ServiceNotifier::ServiceNotifier() {
  std::uint64_t timeout_us = 0;
  // A third of the timeout: two feeds may be missed.
  if (sd_watchdog_enabled(0, &timeout_us) > 0) {
    watchdog_period_ns_ = static_cast<TimeNs>(timeout_us) * kNsPerUs / 3;
  }
  const char* const name = std::getenv("NOTIFY_SOCKET");
  if (name == nullptr) return;
  address_size_ = parse_address(name, address_);
  if (address_size_ == 0) {
    spdlog::warn("NOTIFY_SOCKET={}: expected an absolute path, or @ and a name; systemd gets no messages",
                 name);
    return;
  }
  fd_ = socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (fd_ < 0) spdlog::warn("NOTIFY_SOCKET: no socket ({}); systemd gets no messages", std::strerror(errno));
}

ServiceNotifier::~ServiceNotifier() {
  if (fd_ >= 0) close(fd_);
}

void ServiceNotifier::ready() {
  keep("READY=1");
}

void ServiceNotifier::reloading(TimeNs now_ns) {
  keep("RELOADING=1\nMONOTONIC_USEC=" + std::to_string(now_ns / kNsPerUs));
}

void ServiceNotifier::stopping() {
  keep("STOPPING=1");
}

void ServiceNotifier::status(const std::string& line) {
  if (send_kept() && line != status_ && send("STATUS=" + line)) status_ = line;
}

void ServiceNotifier::alive(TimeNs now_ns) {
  if (watchdog_period_ns_ == 0 || now_ns - t_fed_ns_ < watchdog_period_ns_) return;
  if (send_kept() && send("WATCHDOG=1")) t_fed_ns_ = now_ns;
}

void ServiceNotifier::keep(std::string message) {
  if (fd_ < 0) return;
  kept_.push_back(std::move(message));
  if (kept_.size() > kMaxKept) kept_.pop_front();
  send_kept();
}

bool ServiceNotifier::send_kept() {
  while (!kept_.empty() && send(kept_.front())) kept_.pop_front();
  return kept_.empty();
}

bool ServiceNotifier::send(const std::string& message) const {
  return fd_ < 0 || sendto(fd_, message.data(), message.size(), MSG_NOSIGNAL,
                           reinterpret_cast<const sockaddr*>(&address_), address_size_) >= 0;
}

}  // namespace heel
