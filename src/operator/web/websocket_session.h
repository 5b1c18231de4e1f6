// A WebSocket with a browser: messages in, one after another, and messages out, bounded. A browser that does
// not read, or does not answer a ping, is dropped.
#pragma once

#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <cstddef>
#include <deque>
#include <memory>
#include <string>

#include "operator/web/live_hub.h"
#include "operator/web/page_context.h"
#include "operator/web/websocket_sessions.h"

namespace heel {

class WebSocketSession : public std::enable_shared_from_this<WebSocketSession> {
 public:
  WebSocketSession(boost::beast::tcp_stream&& stream, PageContext& context,
                   std::unique_ptr<Presence> presence);
  virtual ~WebSocketSession() = default;
  /// `protocol`: of those that the browser offers, the one that is spoken; empty: none.
  void start(UpgradeRequest request, const std::string& protocol = "");

 protected:
  /// The connection stands.
  virtual void opened() = 0;
  /// A message of the browser. False: it is none that may come; the connection is closed.
  virtual bool heard(const std::string& text) = 0;
  /// The connection has ended.
  virtual void ended() {}

  void send_message(SharedMessage message);
  void drop();
  /// Bytes that the browser has not taken yet.
  std::size_t waiting_bytes() const { return waiting_bytes_; }
  PageContext& context() { return context_; }
  const std::string& address() const { return presence_->address(); }

 private:
  void read();
  void read_done();
  void write();
  void refuse(const std::string& why);

  boost::beast::websocket::stream<boost::beast::tcp_stream> stream_;
  PageContext& context_;
  std::unique_ptr<Presence> presence_;
  boost::beast::flat_buffer buffer_;
  std::deque<SharedMessage> waiting_;  // the first one is on its way
  std::size_t waiting_bytes_ = 0;
  Allowance messages_;
  bool closed_ = false;
};

}  // namespace heel
