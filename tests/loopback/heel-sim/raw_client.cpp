#include "loopback/heel-sim/raw_client.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <stdexcept>

namespace heel::test {
namespace {

unsigned checksum_of(const Bytes& body) {
  unsigned sum = 0;
  for (std::size_t i = 0; i + 1 < body.size(); i += 2) sum = (sum + body[i] * 256u + body[i + 1]) % 65536u;
  return body.size() % 2 == 1 ? sum ^ body.back() : sum;
}

std::uint8_t byte(unsigned value) {
  return static_cast<std::uint8_t>(value & 0xFF);
}

}  // namespace

Bytes framed(const Bytes& body) {
  Bytes packet;
  packet.reserve(body.size() + 5);
  for (const unsigned value : {0xFAu, 0xFBu, static_cast<unsigned>(body.size()) + 2})
    packet.push_back(byte(value));
  for (const std::uint8_t value : body) packet.push_back(value);
  packet.push_back(byte(checksum_of(body) / 256));
  packet.push_back(byte(checksum_of(body)));
  return packet;
}

Bytes command(int id, int argument) {
  const auto magnitude = static_cast<unsigned>(std::abs(argument));
  return framed({byte(static_cast<unsigned>(id)), byte(argument < 0 ? 0x1B : 0x3B), byte(magnitude),
                 byte(magnitude / 256)});
}

bool is_sip(const Bytes& body) {
  return body.at(0) == 0x32 || is_moving_sip(body);
}

bool is_moving_sip(const Bytes& body) {
  return body.at(0) == 0x33;
}

int i16_at(const Bytes& body, std::size_t offset) {
  return static_cast<std::int16_t>(body.at(offset) + body.at(offset + 1) * 256);
}

RawClient RawClient::on_pty(const std::string& path) {
  const int fd = open(path.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
  if (fd < 0) throw std::runtime_error("cannot open " + path);
  return RawClient(fd);
}

RawClient RawClient::on_tcp(int port) {
  const int fd = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (connect(fd, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0) {
    throw std::runtime_error("cannot connect to port " + std::to_string(port));
  }
  return RawClient(fd);
}

RawClient RawClient::at(const std::string& address) {
  if (address.starts_with("pty:")) return on_pty(address.substr(4));
  return on_tcp(std::stoi(address.substr(address.rfind(':') + 1)));
}

void RawClient::hang_up() {
  if (fd_ >= 0) ::close(fd_);
  fd_ = -1;
}

bool RawClient::is_hung_up_on(double timeout_s) {
  for (const double end_s = monotonic_s() + timeout_s; monotonic_s() < end_s;) {
    pollfd state{fd_, POLLIN, 0};
    if (poll(&state, 1, 20) <= 0) continue;
    std::array<std::uint8_t, 512> buffer{};
    const ssize_t size = read(fd_, buffer.data(), buffer.size());
    if (size <= 0) return true;
    raw.insert(raw.end(), buffer.begin(), buffer.begin() + size);
  }
  return false;
}

void RawClient::set_rate(speed_t rate) const {
  termios settings{};
  tcgetattr(fd_, &settings);
  cfsetispeed(&settings, rate);
  cfsetospeed(&settings, rate);
  tcsetattr(fd_, TCSANOW, &settings);
}

void RawClient::send(const Bytes& bytes) const {
  if (write(fd_, bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size())) {
    throw std::runtime_error("short write to the robot");
  }
}

bool RawClient::read_some(double timeout_s) {
  pollfd state{fd_, POLLIN, 0};
  if (poll(&state, 1, static_cast<int>(timeout_s * 1e3)) <= 0) return false;
  std::array<std::uint8_t, 512> buffer{};
  const ssize_t size = read(fd_, buffer.data(), buffer.size());
  if (size <= 0) throw std::runtime_error("the robot hung up");
  raw.insert(raw.end(), buffer.begin(), buffer.begin() + size);
  unparsed_.insert(unparsed_.end(), buffer.begin(), buffer.begin() + size);
  parse();
  return true;
}

void RawClient::parse() {
  while (unparsed_.size() >= 3) {
    const std::size_t count = unparsed_[2];
    if (unparsed_[0] != 0xFA || unparsed_[1] != 0xFB || count < 3) {
      unparsed_.erase(unparsed_.begin());
      continue;
    }
    if (unparsed_.size() < 3 + count) return;
    const Bytes body(unparsed_.begin() + 3, unparsed_.begin() + 1 + static_cast<std::ptrdiff_t>(count));
    const unsigned sum = unparsed_[1 + count] * 256u + unparsed_[2 + count];
    const bool good = sum == checksum_of(body);
    if (good) packets.push_back(body);
    unparsed_.erase(unparsed_.begin(),
                    unparsed_.begin() + (good ? 3 + static_cast<std::ptrdiff_t>(count) : 1));
  }
}

void RawClient::listen(double seconds) {
  const double end_s = monotonic_s() + seconds;
  for (double left_s = seconds; left_s > 0.0; left_s = end_s - monotonic_s()) read_some(left_s);
  while (read_some(0.0)) {
  }
}

Bytes RawClient::wait_for(const std::function<bool(const Bytes&)>& wanted, double timeout_s) {
  const double end_s = monotonic_s() + timeout_s;
  std::size_t checked = packets.size();
  while (monotonic_s() < end_s) {
    read_some(0.05);
    for (; checked < packets.size(); ++checked) {
      if (wanted(packets[checked])) return packets[checked];
    }
  }
  return {};
}

Bytes RawClient::next_sip(double timeout_s) {
  return wait_for(is_sip, timeout_s);
}

bool RawClient::sync() {
  for (int id = 0; id < 3; ++id) {
    const bool echoed = eventually([&] {
      send(id);
      return !wait_for([&](const Bytes& body) { return body.at(0) == id; }, 0.5).empty();
    });
    if (!echoed) return false;
  }
  return true;
}

bool RawClient::falls_silent() {
  return eventually([&] {
    const std::size_t before = raw.size();
    listen(0.5);
    return raw.size() == before;
  });
}

}  // namespace heel::test
