#include "support/page_client.h"

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <stdexcept>

namespace heel::test {

PageClient::PageClient(std::uint16_t port, int receive_buffer)
    : fd_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)), port_(port) {
  if (receive_buffer > 0) setsockopt(fd_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (connect(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    throw std::runtime_error("nothing serves port " + std::to_string(port));
}

PageClient::~PageClient() {
  close(fd_);
}

bool PageClient::send(const std::string& bytes) const {
  std::size_t sent = 0;
  while (sent < bytes.size()) {
    const ssize_t count = ::send(fd_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (count <= 0) return false;
    sent += static_cast<std::size_t>(count);
  }
  return true;
}

bool PageClient::read_more(double timeout_s) {
  if (closed_) return false;
  pollfd ready{fd_, POLLIN, 0};
  if (poll(&ready, 1, static_cast<int>(1000 * timeout_s)) <= 0) return false;
  std::array<char, 65536> bytes{};
  const ssize_t count = recv(fd_, bytes.data(), bytes.size(), 0);
  closed_ = count <= 0;
  if (!closed_) waiting_.append(bytes.data(), static_cast<std::size_t>(count));
  return !closed_;
}

bool PageClient::has(std::size_t bytes) {
  while (waiting_.size() < bytes)
    if (!read_more(kPatience_s)) return false;
  return true;
}

bool PageClient::closed(double timeout_s) {
  const double t_end_s = monotonic_s() + timeout_s;
  while (!closed_ && monotonic_s() < t_end_s) read_more(t_end_s - monotonic_s());
  return closed_;
}

HttpAnswer PageClient::answer() {
  HttpAnswer answer;
  std::size_t end = 0;
  while ((end = waiting_.find("\r\n\r\n")) == std::string::npos)
    if (!read_more(kPatience_s)) return answer;
  answer.head = waiting_.substr(0, end + 2);
  waiting_.erase(0, end + 4);
  answer.status = std::stoi(answer.head.substr(9, 3));
  const std::size_t length = answer.head.find("Content-Length: ");
  if (length == std::string::npos) return answer;
  const std::size_t bytes = std::stoul(answer.head.substr(length + 16));
  if (!has(bytes)) return answer;
  answer.body = waiting_.substr(0, bytes);
  waiting_.erase(0, bytes);
  return answer;
}

HttpAnswer PageClient::ask(const std::string& method_and_target, const std::string& more) {
  const std::string host =
      more.find("Host:") == std::string::npos ? "Host: 127.0.0.1:" + std::to_string(port_) + "\r\n" : "";
  send(method_and_target + " HTTP/1.1\r\n" + host + more + "\r\n");
  return answer();
}

bool PageClient::become_websocket(const std::string& path, const std::string& more) {
  return ask("GET " + path,
             "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
             "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n" +
                 more)
             .status == 101;
}

bool PageClient::send_frame(std::uint8_t first_byte, const std::string& payload, bool masked) const {
  const std::uint8_t mask_bit = masked ? 0x80 : 0;
  std::string frame(1, static_cast<char>(first_byte));
  if (payload.size() < 126) {
    frame += static_cast<char>(mask_bit | payload.size());
  } else {
    frame += static_cast<char>(mask_bit | 126);
    frame += static_cast<char>(payload.size() >> 8);
    frame += static_cast<char>(payload.size() & 255);
  }
  if (masked) frame.append(4, '\0');  // a mask of zeros leaves the bytes as they are
  return send(frame + payload);
}

std::string PageClient::message() {
  while (has(2)) {
    const int opcode = waiting_[0] & 15;
    std::size_t bytes = waiting_[1] & 127;
    std::size_t head = 2;
    if (bytes >= 126) {
      head = bytes == 126 ? 4 : 10;
      if (!has(head)) return "";
      bytes = 0;
      for (std::size_t i = 2; i < head; ++i) bytes = bytes << 8 | static_cast<std::uint8_t>(waiting_[i]);
    }
    if (!has(head + bytes)) return "";
    const std::string payload = waiting_.substr(head, bytes);
    waiting_.erase(0, head + bytes);
    if (opcode == 8) return "";
    if (opcode <= 2) return payload;
  }
  return "";
}

nlohmann::json PageClient::message_of(const std::string& type, const std::string& field) {
  for (std::string text = message(); !text.empty(); text = message()) {
    const nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
    if (json.is_object() && json.value(field, "") == type) return json;
  }
  return nullptr;
}

}  // namespace heel::test
