// A client of the page's server, byte by byte: what it sends may be as wrong as a test wants it.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "support/process.h"

namespace heel::test {

struct HttpAnswer {
  int status = 0;    ///< 0: none has come
  std::string head;  ///< with the status line
  std::string body;
  nlohmann::json json() const { return nlohmann::json::parse(body, nullptr, false); }
};

class PageClient {
 public:
  /// Connects to 127.0.0.1. `receive_buffer`: bytes that the kernel keeps for it; 0: as usual.
  explicit PageClient(std::uint16_t port, int receive_buffer = 0);
  ~PageClient();
  PageClient(const PageClient&) = delete;
  PageClient& operator=(const PageClient&) = delete;

  /// False: the server has closed.
  bool send(const std::string& bytes) const;
  /// True as soon as the server has closed.
  bool closed(double timeout_s = kPatience_s);
  HttpAnswer answer();
  /// "GET /api/info", with a Host and more lines such as "Origin: http://evil\r\n".
  HttpAnswer ask(const std::string& method_and_target, const std::string& more = "");

  /// True: the server has agreed.
  bool become_websocket(const std::string& path, const std::string& more = "");
  bool send_frame(std::uint8_t first_byte, const std::string& payload, bool masked = true) const;
  bool send_text(const std::string& text) const { return send_frame(0x81, text); }
  /// The next message; empty: the server has closed, or said that it closes.
  std::string message();
  /// The next JSON message with this value of the field; null: the server has closed.
  nlohmann::json message_of(const std::string& type, const std::string& field = "type");
  /// Sends a text and returns the next one.
  nlohmann::json ask_json(const std::string& text) {
    send_text(text);
    return nlohmann::json::parse(message(), nullptr, false);
  }

 private:
  /// False: nothing has come in time, or the server has closed.
  bool read_more(double timeout_s);
  bool has(std::size_t bytes);

  int fd_ = -1;
  std::uint16_t port_;
  std::string waiting_;
  bool closed_ = false;
};

}  // namespace heel::test
