// The line over a real pty and a real TCP connection: bytes in both directions, partial writes, loss,
// refusals.
#include "robot/serial_line.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <pty.h>
#include <sys/file.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "robot/device_holder.h"
#include "robot/serial_hints.h"

namespace heel {
namespace {

using Clock = std::chrono::steady_clock;

/// A pty whose slave has a name.
struct Pty {
  int master = -1;
  std::string slave_path;
  Pty() {
    int slave = -1;
    char name[128] = {};
    if (::openpty(&master, &slave, name, nullptr, nullptr) != 0) throw std::runtime_error("no pty");
    slave_path = name;
    ::close(slave);
  }
  ~Pty() { hang_up(); }
  void hang_up() {
    if (master >= 0) ::close(master);
    master = -1;
  }
};

/// A listening socket on a free port of this host.
struct Listener {
  int fd = -1;
  int port = 0;
  Listener() : fd(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(address);
    ::bind(fd, reinterpret_cast<sockaddr*>(&address), size);
    ::listen(fd, 1);
    ::getsockname(fd, reinterpret_cast<sockaddr*>(&address), &size);
    port = ntohs(address.sin_port);
  }
  ~Listener() { ::close(fd); }
};

bool open_line(SerialLine& line, const std::string& address) {
  return line.open(parse_robot_address(address), 38400);
}

std::vector<std::uint8_t> read_within(SerialLine& line, std::size_t size) {
  std::vector<std::uint8_t> all;
  std::array<std::uint8_t, 64> chunk{};
  while (all.size() < size && line.wait_readable(60 * kNsPerS)) {
    const auto got = line.read(chunk);
    if (got.status == SerialLine::Status::Lost) break;
    all.insert(all.end(), chunk.begin(), chunk.begin() + got.count);
  }
  return all;
}

/// Every byte value, so that a terminal's changes to bytes show.
std::vector<std::uint8_t> all_bytes() {
  std::vector<std::uint8_t> bytes(256);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(i);
  return bytes;
}

void expect_bytes_both_ways(SerialLine& line, int peer) {
  const auto bytes = all_bytes();
  EXPECT_EQ(line.write(bytes).count, bytes.size());
  EXPECT_TRUE(line.drain(60 * kNsPerS));
  std::vector<std::uint8_t> there(bytes.size());
  std::size_t count = 0;
  while (count < there.size()) {
    const ssize_t got = ::read(peer, there.data() + count, there.size() - count);
    ASSERT_GT(got, 0);
    count += static_cast<std::size_t>(got);
  }
  EXPECT_EQ(there, bytes);
  ASSERT_EQ(::write(peer, bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  EXPECT_EQ(read_within(line, bytes.size()), bytes);
}

TEST(SerialLinePty, BytesPassUnchangedInBothDirections) {
  Pty pty;
  SerialLine line;
  ASSERT_TRUE(open_line(line, "pty:" + pty.slave_path)) << line.error();
  expect_bytes_both_ways(line, pty.master);
}

TEST(SerialLinePty, NothingToReadIsNotALoss) {
  Pty pty;
  SerialLine line;
  ASSERT_TRUE(open_line(line, "pty:" + pty.slave_path));
  std::array<std::uint8_t, 16> chunk{};
  const auto got = line.read(chunk);
  EXPECT_EQ(got.count, 0u);
  EXPECT_EQ(got.status, SerialLine::Status::Ok);
  const auto begin = Clock::now();
  EXPECT_FALSE(line.wait_readable(20 * kNsPerMs));
  EXPECT_GE(Clock::now() - begin, std::chrono::milliseconds(20));
}

TEST(SerialLinePty, AHangUpIsALossForReadAndForWrite) {
  Pty pty;
  SerialLine line;
  ASSERT_TRUE(open_line(line, "pty:" + pty.slave_path));
  pty.hang_up();
  std::array<std::uint8_t, 16> chunk{};
  EXPECT_EQ(line.read(chunk).status, SerialLine::Status::Lost);
  EXPECT_EQ(line.write(std::span(chunk)).status, SerialLine::Status::Lost);
}

TEST(SerialLinePty, AFullDriverTakesNothingAndDoesNotBlock) {
  Pty pty;
  SerialLine line;
  ASSERT_TRUE(open_line(line, "pty:" + pty.slave_path));
  const std::vector<std::uint8_t> much(100'000, 0x55);
  std::size_t taken = 0;
  SerialLine::Transfer put;
  do {
    put = line.write(much);
    taken += put.count;
  } while (put.count > 0);
  EXPECT_EQ(put.status, SerialLine::Status::Ok);
  EXPECT_GT(taken, 0u);  // a write that blocks would not have returned
}

speed_t rate_seen_by(int master) {
  termios settings{};
  ::tcgetattr(master, &settings);
  return ::cfgetospeed(&settings);
}

TEST(SerialLinePty, TheOtherEndSeesItsRate) {
  Pty pty;
  SerialLine line;
  ASSERT_TRUE(line.open(parse_robot_address("pty:" + pty.slave_path), 19200));
  EXPECT_EQ(rate_seen_by(pty.master), B19200);
  const std::pair<int, speed_t> rates[] = {
      {9600, B9600}, {38400, B38400}, {57600, B57600}, {115200, B115200}, {19200, B19200}};
  for (const auto& [baud, speed] : rates) {
    EXPECT_TRUE(line.set_baud(baud));
    EXPECT_EQ(rate_seen_by(pty.master), speed) << baud;
  }
  expect_bytes_both_ways(line, pty.master);  // still raw
  pty.hang_up();
  EXPECT_FALSE(line.set_baud(9600));
  EXPECT_FALSE(line.is_open());
}

TEST(SerialLinePty, AChangeOfRateDropsTheBytesInTransit) {
  Pty pty;
  SerialLine line;
  ASSERT_TRUE(open_line(line, "pty:" + pty.slave_path));
  ASSERT_EQ(::write(pty.master, "old", 3), 3);
  ASSERT_TRUE(line.wait_readable(60 * kNsPerS));
  EXPECT_TRUE(line.set_baud(9600));
  EXPECT_FALSE(line.wait_readable(20 * kNsPerMs));
}

TEST(SerialLineTcp, BytesPassInBothDirectionsAndTheLineIsLostWhenThePeerCloses) {
  Listener listener;
  SerialLine line;
  ASSERT_TRUE(open_line(line, "tcp:127.0.0.1:" + std::to_string(listener.port))) << line.error();
  const int peer = ::accept(listener.fd, nullptr, nullptr);
  expect_bytes_both_ways(line, peer);
  ::close(peer);
  ASSERT_TRUE(line.wait_readable(60 * kNsPerS));
  std::array<std::uint8_t, 16> chunk{};
  EXPECT_EQ(line.read(chunk).status, SerialLine::Status::Lost);
}

TEST(SerialLineTcp, UnsentBytesShowThatThePeerDoesNotRead) {
  Listener listener;
  SerialLine line;
  ASSERT_TRUE(open_line(line, "tcp:127.0.0.1:" + std::to_string(listener.port)));
  const std::vector<std::uint8_t> much(100'000, 0x55);
  while (line.write(much).count > 0) {
  }
  EXPECT_GT(line.unsent_bytes(), 0u);
  EXPECT_FALSE(line.drain(10 * kNsPerMs));
}

struct Refusal {
  const char* address;
  const char* said;
};

TEST(SerialLineRefusal, IsOneLineThatNamesTheAddressAndTheReason) {
  const Refusal refusals[] = {
      {"pty:/nonexistent/pty", "No such file"},
      {"pty:/dev/null", "is not a terminal"},
      {"serial:/nonexistent/tty@9600", "No such file"},
      {"serial:/dev/null@9600", "is not a serial port"},
      {"tcp:127.0.0.1:1", "Connection refused (nothing listens on that port)"},
  };
  for (const Refusal& refusal : refusals) {
    SerialLine line;
    EXPECT_FALSE(open_line(line, refusal.address));
    EXPECT_FALSE(line.is_open());
    EXPECT_NE(line.error().find(refusal.said), std::string::npos) << line.error();
    EXPECT_EQ(line.error().find(std::string("robot ") + refusal.address), 0u) << line.error();
    EXPECT_EQ(line.error().find('\n'), std::string::npos);
  }
}

TEST(SerialLineClosed, EveryCallReturnsLost) {
  SerialLine line;
  std::array<std::uint8_t, 4> chunk{};
  EXPECT_EQ(line.read(chunk).status, SerialLine::Status::Lost);
  EXPECT_EQ(line.write(chunk).status, SerialLine::Status::Lost);
  EXPECT_FALSE(line.wait_readable(0));
  EXPECT_EQ(line.unsent_bytes(), 0u);
}

/// Another process that opens a device, and locks it if it is asked to, until the end of this object.
class OtherProgram {
 public:
  OtherProgram(const std::string& path, bool locks) {
    int ready[2] = {};
    if (::pipe(ready) != 0) throw std::runtime_error("no pipe");
    pid_ = ::fork();
    if (pid_ == 0) {
      const int fd = ::open(path.c_str(), O_RDWR | O_NOCTTY);
      if (locks) ::flock(fd, LOCK_EX);
      ::prctl(PR_SET_NAME, "minicom");
      const char done = fd >= 0 ? 1 : 0;
      if (::write(ready[1], &done, 1) == 1) ::pause();
      ::_exit(0);
    }
    char done = 0;
    opened = ::read(ready[0], &done, 1) == 1 && done == 1;
    ::close(ready[0]);
    ::close(ready[1]);
  }
  ~OtherProgram() {
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }
  OtherProgram(const OtherProgram&) = delete;
  OtherProgram& operator=(const OtherProgram&) = delete;
  std::string text() const {
    return "in use by minicom (process " + std::to_string(pid_) + "); stop it first";
  }
  bool opened = false;

 private:
  pid_t pid_ = -1;
};

TEST(SerialLine, IsHeldByOneProgramAtATime) {
  Pty pty;
  SerialLine first, second;
  ASSERT_TRUE(open_line(first, "pty:" + pty.slave_path));
  EXPECT_FALSE(open_line(second, "pty:" + pty.slave_path));
  EXPECT_NE(second.error().find("in use by another program; stop it first"), std::string::npos)
      << second.error() << ": this process holds it, by another descriptor";
  expect_bytes_both_ways(first, pty.master);
  first.close();
  EXPECT_TRUE(open_line(second, "pty:" + pty.slave_path)) << second.error();
}

TEST(SerialLine, TheProgramThatLockedItIsNamed) {
  Pty pty;
  const OtherProgram other(pty.slave_path, true);
  ASSERT_TRUE(other.opened);
  SerialLine line;
  EXPECT_FALSE(open_line(line, "pty:" + pty.slave_path));
  EXPECT_EQ(line.error(), "robot pty:" + pty.slave_path + ": " + other.text());
}

TEST(DeviceHolder, FindsAProgramThatHasItOpenWithoutALock) {
  Pty pty;
  EXPECT_FALSE(other_holder_of(pty.slave_path).has_value());
  const OtherProgram other(pty.slave_path, false);
  ASSERT_TRUE(other.opened);
  EXPECT_EQ(in_use_text(other_holder_of(pty.slave_path)), other.text());
  EXPECT_FALSE(other_holder_of("/nonexistent").has_value());
}

TEST(SerialHints, APtyIsNoSerialPort) {
  Pty pty;
  EXPECT_TRUE(is_pty(pty.slave_path));
  EXPECT_FALSE(is_pty("/dev/null"));
  EXPECT_FALSE(is_pty("/nonexistent"));
  SerialLine line;
  EXPECT_FALSE(open_line(line, "serial:" + pty.slave_path));
  EXPECT_EQ(line.error(),
            "robot serial:" + pty.slave_path + ": is a pty (expected pty:" + pty.slave_path + ")");
}

}  // namespace
}  // namespace heel
