#include "robot/serial_line.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <libserialport.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <system_error>

#include "realtime/clock.h"
#include "robot/device_holder.h"
#include "robot/serial_hints.h"
#include "robot/tcp_connect.h"

namespace heel {
namespace {

constexpr TimeNs kLookPeriod_ns = 2 * kNsPerMs;  // for bytes of a terminal; each look costs 10 µs
constexpr TimeNs kHangUp_ns = 2 * kNsPerS;  // from the first error of a port to its hang-up by the kernel

/// ppoll for one descriptor. True: one of `events`, an error or a hang-up has occurred.
bool poll_one(int fd, short events, TimeNs timeout_ns, short* seen = nullptr) {
  pollfd entry{fd, events, 0};
  const timespec timeout{static_cast<time_t>(timeout_ns / kNsPerS), static_cast<long>(timeout_ns % kNsPerS)};
  const bool ready = ::ppoll(&entry, 1, &timeout, nullptr) > 0;
  if (seen != nullptr) *seen = entry.revents;
  return ready;
}

speed_t termios_speed(int baud) {
  constexpr std::array<speed_t, kRobotBauds.size()> kSpeeds = {B9600, B19200, B38400, B57600, B115200};
  for (std::size_t i = 0; i < kSpeeds.size(); ++i) {
    if (kRobotBauds[i] == baud) return kSpeeds[i];
  }
  return B9600;
}

std::string last_serial_error() {
  char* const text = sp_last_error_message();
  std::string error = text != nullptr ? text : "unknown error";
  sp_free_error_message(text);
  return error;
}

}  // namespace

bool SerialLine::fail(const std::string& why) {
  close();
  error_ = fmt::format("robot {}: {}", name_, why);
  return false;
}

bool SerialLine::open(const RobotAddress& address, int baud) {
  close();
  kind_ = address.kind;
  name_ = address.text;
  error_.clear();
  note_.clear();
  switch (kind_) {
    case RobotAddress::Kind::Serial:
      return open_serial(address, baud);
    case RobotAddress::Kind::Pty:
      return open_pty(address, baud);
    case RobotAddress::Kind::Tcp:
      return open_tcp(address);
  }
  return false;
}

/// A second program on the line would break the session of the first: its bytes mix with them, and its CLOSE
/// ends it. The lock keeps out those that ask for one, such as another heeld; TIOCEXCL keeps out those that
/// do not, root's excepted. Both end with the descriptor, but TIOCEXCL not on a pty whose other end is still
/// open: after a kill nobody could open it again, so a pty has the lock alone.
bool SerialLine::claim(const std::string& device) {
  if (::flock(fd_, LOCK_EX | LOCK_NB) != 0)
    return fail(errno == EWOULDBLOCK ? in_use_text(other_holder_of(device))
                                     : fmt::format("cannot lock: {}", std::strerror(errno)));
  if (kind_ == RobotAddress::Kind::Serial) ::ioctl(fd_, TIOCEXCL);
  return true;
}

/// The device's kernel name; libserialport knows no other, so udev's symlinks are resolved. An adapter that
/// was here before and came back under another name is found there. Empty: it is not here.
std::string SerialLine::find_device(const std::string& path) {
  std::error_code missing;
  const std::string device = std::filesystem::canonical(path, missing).string();
  if (!missing) return device;
  const auto moved = adapter_ ? moved_to(*adapter_, usb_adapters()) : std::nullopt;
  if (!moved) return "";
  note_ =
      fmt::format("robot {}: the adapter that it named is {} now; a name that stays is in /dev/serial/by-id",
                  name_, moved->device);
  return moved->device;
}

bool SerialLine::open_serial(const RobotAddress& address, int baud) {
  const std::string device = find_device(address.path);
  if (device.empty()) return fail(missing_device_text());
  if (is_pty(device)) return fail(fmt::format("is a pty (expected pty:{})", address.path));
  if (sp_get_port_by_name(device.c_str(), &port_) != SP_OK) {
    return fail("is not a serial port (expected a device such as /dev/ttyUSB0)");
  }
  // A program that opened the port without a lock: opening it would set its rate and mix the bytes.
  if (const auto holder = other_holder_of(device)) return fail(in_use_text(holder));
  if (sp_open(port_, SP_MODE_READ_WRITE) != SP_OK)
    return fail(open_failure_text(device, sp_last_error_code()));
  sp_get_port_handle(port_, &fd_);
  if (!claim(device)) return false;
  adapter_ = usb_adapter_of(device);
  const bool configured = sp_set_baudrate(port_, baud) == SP_OK && sp_set_bits(port_, 8) == SP_OK &&
                          sp_set_parity(port_, SP_PARITY_NONE) == SP_OK &&
                          sp_set_stopbits(port_, 1) == SP_OK &&
                          sp_set_flowcontrol(port_, SP_FLOWCONTROL_NONE) == SP_OK;
  if (!configured) return fail("cannot configure: " + last_serial_error());
  sp_flush(port_, SP_BUF_BOTH);  // bytes of an earlier session
  return true;
}

bool SerialLine::open_pty(const RobotAddress& address, int baud) {
  fd_ = ::open(address.path.c_str(), O_RDWR | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
  if (fd_ < 0) return fail(open_failure_text(address.path, errno));
  if (::isatty(fd_) == 0) return fail("is not a terminal (expected the path of a pty)");
  if (!claim(address.path)) return false;
  return configure_pty(baud) || fail(fmt::format("cannot configure: {}", std::strerror(errno)));
}

/// A pty carries bytes at any speed; the simulated robot at its other end reads the rate from its settings.
bool SerialLine::configure_pty(int baud) {
  termios settings{};
  if (::tcgetattr(fd_, &settings) != 0) return false;
  ::cfmakeraw(&settings);
  ::cfsetspeed(&settings, termios_speed(baud));
  return ::tcsetattr(fd_, TCSANOW, &settings) == 0;
}

bool SerialLine::open_tcp(const RobotAddress& address) {
  std::string why;
  fd_ = tcp_connect(address.host, address.port, 3 * kNsPerS, why);
  if (fd_ < 0) return fail(why);
  const int on = 1;
  ::setsockopt(fd_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));  // commands must not wait for more data
  return true;
}

bool SerialLine::set_baud(int baud) {
  if (kind_ == RobotAddress::Kind::Tcp) return true;
  if (fd_ < 0) return false;
  if (kind_ == RobotAddress::Kind::Pty) {
    ::tcflush(fd_, TCIOFLUSH);
    return configure_pty(baud) || fail(fmt::format("cannot set {} baud: {}", baud, std::strerror(errno)));
  }
  sp_flush(port_, SP_BUF_BOTH);
  if (sp_set_baudrate(port_, baud) == SP_OK) return true;
  return fail(fmt::format("cannot set {} baud: {}", baud, last_serial_error()));
}

void SerialLine::close() {
  if (port_ != nullptr) {
    // Closing a port waits up to half a minute for its output to be sent: what is left is dropped.
    if (fd_ >= 0) {
      ::tcflush(fd_, TCOFLUSH);
      // Drivers of USB adapters drop nothing. An adapter that was unplugged gives errors before the kernel
      // hangs up its port. If the port is closed in between, the kernel waits too, and the adapter is not
      // found again meanwhile.
      if (unsent_bytes() > 0) poll_one(fd_, 0, kHangUp_ns);
      sp_close(port_);
    }
    sp_free_port(port_);
    port_ = nullptr;
  } else if (fd_ >= 0) {
    ::close(fd_);
  }
  fd_ = -1;
}

bool SerialLine::wait_readable(TimeNs timeout_ns) const {
  if (fd_ < 0) return false;
  if (kind_ == RobotAddress::Kind::Tcp) return poll_one(fd_, POLLIN, timeout_ns);
  for (const TimeNs end_ns = monotonic_now_ns() + timeout_ns;;) {
    if (bytes_in_terminal() != 0) return true;
    const TimeNs now_ns = monotonic_now_ns();
    if (now_ns >= end_ns) return false;
    sleep_until_ns(std::min(now_ns + kLookPeriod_ns, end_ns));
  }
}

/// A negative number: the terminal has hung up. poll() and a read() that finds nothing would wait in the
/// kernel for a work queue thread of ordinary priority (n_tty_poll, __flush_work), which busy programs hold
/// up for tens of milliseconds; this does not.
int SerialLine::bytes_in_terminal() const {
  int count = 0;
  return ::ioctl(fd_, FIONREAD, &count) == 0 ? count : -1;
}

SerialLine::Transfer SerialLine::read(std::span<std::uint8_t> into) {
  if (fd_ < 0) return {0, Status::Lost};
  std::size_t size = into.size();
  if (kind_ == RobotAddress::Kind::Tcp) {
    // After poll has reported input, 0 bytes mean that the line has ended.
    short seen = 0;
    if (!poll_one(fd_, POLLIN, 0, &seen)) return {};
    if ((seen & POLLIN) == 0) return {0, Status::Lost};
  } else {
    const int there = bytes_in_terminal();
    if (there == 0) return {};
    if (there < 0) return {0, Status::Lost};
    size = std::min(size, static_cast<std::size_t>(there));
  }
  const ssize_t count = ::read(fd_, into.data(), size);
  if (count > 0) return {static_cast<std::size_t>(count), Status::Ok};
  if (count < 0 && (errno == EAGAIN || errno == EINTR)) return {};
  return {0, Status::Lost};
}

SerialLine::Transfer SerialLine::write(std::span<const std::uint8_t> bytes) {
  if (fd_ < 0) return {0, Status::Lost};
  if (bytes.empty()) return {};
  const ssize_t count = kind_ == RobotAddress::Kind::Tcp
                            ? ::send(fd_, bytes.data(), bytes.size(), MSG_NOSIGNAL)
                            : ::write(fd_, bytes.data(), bytes.size());
  if (count >= 0) return {static_cast<std::size_t>(count), Status::Ok};
  if (errno == EAGAIN || errno == EINTR) return {};
  return {0, Status::Lost};
}

std::size_t SerialLine::unsent_bytes() const {
  int count = 0;
  if (fd_ < 0 || ::ioctl(fd_, TIOCOUTQ, &count) != 0 || count < 0) return 0;
  return static_cast<std::size_t>(count);
}

bool SerialLine::drain(TimeNs timeout_ns) const {
  constexpr TimeNs kStep_ns = 2 * kNsPerMs;
  const timespec step{0, kStep_ns};
  for (TimeNs waited_ns = 0; unsent_bytes() > 0; waited_ns += kStep_ns) {
    if (waited_ns >= timeout_ns) return false;
    ::nanosleep(&step, nullptr);
  }
  return true;
}

}  // namespace heel
