#include "sim/transport/pty_transport.h"

#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <termios.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "heel/error.h"
#include "sim/transport/terminal_rate.h"

namespace heel::sim {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail_with_errno(const std::string& what) {
  throw Error(what + ": " + std::strerror(errno));
}

/// The link by its folder's real path: not where it leads to.
std::string full_path(const std::string& link_path) {
  std::error_code error;
  const fs::path absolute = fs::absolute(link_path, error);
  const fs::path folder = fs::weakly_canonical(absolute.parent_path(), error);
  return (folder / absolute.filename()).string();
}

FileDescriptor open_slave(const std::string& slave_path) {
  return FileDescriptor(::open(slave_path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
}

speed_t named_rate(int baud) {
  switch (baud) {
    case 19200:
      return B19200;
    case 38400:
      return B38400;
    case 57600:
      return B57600;
    case 115200:
      return B115200;
    default:
      return B9600;
  }
}

void make_raw(int fd, int baud) {
  termios settings{};
  if (tcgetattr(fd, &settings) != 0) return;
  cfmakeraw(&settings);
  cfsetspeed(&settings, named_rate(baud));
  tcsetattr(fd, TCSANOW, &settings);
}

/// Replaces the symlink in one step (rename), so that clients find it at any time.
void place_symlink(const std::string& target, const std::string& link_path) {
  const fs::file_status present = fs::symlink_status(link_path);
  if (fs::exists(present) && !fs::is_symlink(present)) {
    throw Error("--robot pty:" + link_path + ": exists and is not a symlink (expected a free path)");
  }
  const std::string temporary = link_path + ".new";
  std::error_code error;
  fs::remove(temporary, error);
  fs::create_symlink(target, temporary, error);
  if (!error) fs::rename(temporary, link_path, error);
  if (error) throw Error("--robot pty:" + link_path + ": cannot make the symlink: " + error.message());
}

}  // namespace

PtyTransport::PtyTransport(const std::string& link_path, int boot_baud)
    : link_path_(link_path), guard_(full_path(link_path), "--robot pty:" + link_path) {
  master_ = FileDescriptor(posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  if (!master_.valid()) fail_with_errno("cannot open a pseudo-terminal");
  if (grantpt(master_.get()) != 0 || unlockpt(master_.get()) != 0)
    fail_with_errno("cannot unlock the pseudo-terminal");
  std::array<char, 128> name{};
  if (ptsname_r(master_.get(), name.data(), name.size()) != 0)
    fail_with_errno("the pseudo-terminal has no name");
  slave_path_ = name.data();
  {
    // Opened and closed once: only then does the master report a hang-up while no client is connected.
    const FileDescriptor slave = open_slave(slave_path_);
    if (!slave.valid()) fail_with_errno(slave_path_ + ": cannot open");
    make_raw(slave.get(), boot_baud);
  }
  place_symlink(slave_path_, link_path_);
}

PtyTransport::~PtyTransport() {
  std::error_code error;
  if (fs::read_symlink(link_path_, error) == slave_path_) fs::remove(link_path_, error);
}

bool PtyTransport::client_present() {
  pollfd state{master_.get(), POLLIN, 0};
  const bool present = ::poll(&state, 1, 0) >= 0 && (state.revents & POLLHUP) == 0;
  if (client_was_present_ && !present) discard_unread();
  client_was_present_ = present;
  return present;
}

std::size_t PtyTransport::read(std::span<std::uint8_t> into) {
  const ssize_t size = ::read(master_.get(), into.data(), into.size());
  return size > 0 ? static_cast<std::size_t>(size) : 0;  // EAGAIN: nothing now; EIO: no client
}

void PtyTransport::write(std::span<const std::uint8_t> bytes) {
  if (!client_was_present_) return;
  while (!bytes.empty()) {
    const ssize_t size = ::write(master_.get(), bytes.data(), bytes.size());
    if (size <= 0) return;
    bytes = bytes.subspan(static_cast<std::size_t>(size));
  }
}

int PtyTransport::host_baud() const {
  return terminal_rate(master_.get());
}

/// The next client must not read what the last one left: a real port's buffer is emptied at close.
void PtyTransport::discard_unread() {
  const FileDescriptor slave = open_slave(slave_path_);
  if (slave.valid()) tcflush(slave.get(), TCIFLUSH);
}

}  // namespace heel::sim
