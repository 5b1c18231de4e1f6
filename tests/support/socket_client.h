// A client of a local stream socket, line by line.
#pragma once

#include <string>

#include "support/process.h"

namespace heel::test {

class SocketClient {
 public:
  /// Connects; throws std::runtime_error when nothing serves the socket.
  explicit SocketClient(const std::string& path);
  ~SocketClient();
  SocketClient(const SocketClient&) = delete;
  SocketClient& operator=(const SocketClient&) = delete;

  /// False: the other end has closed, or its buffer is full (the socket does not block).
  bool send(const std::string& bytes) const;
  /// The next line without its end; empty when none has come in time or the other end has closed.
  std::string line(double timeout_s = kPatience_s);
  /// True as soon as the other end has closed; reads what is before it.
  bool closed(double timeout_s = kPatience_s);
  /// No more is sent; the other end sees the end of its input.
  void end_output() const;
  /// Sends a line and waits for the next one.
  std::string ask(const std::string& request) {
    send(request + "\n");
    return line();
  }

 private:
  bool read_more(double timeout_s);

  int fd_ = -1;
  std::string waiting_;
  bool closed_ = false;
};

}  // namespace heel::test
