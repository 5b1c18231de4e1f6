// A connection that speaks HTTP: requests and answers one after another, until it ends or becomes a
// WebSocket.
#pragma once

#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>
#include <memory>
#include <optional>

#include "operator/web/page_context.h"

namespace heel {

class HttpSession : public std::enable_shared_from_this<HttpSession> {
 public:
  HttpSession(boost::asio::ip::tcp::socket&& socket, PageContext& context,
              std::unique_ptr<Presence> presence);
  void start();

 private:
  void read();
  void read_done(boost::beast::error_code error);
  void refuse_bytes(boost::beast::error_code error);
  void serve();
  void become_websocket(const PageRequest& request);
  void stop_robot();
  void await_stop(std::uint64_t request_number, TimeNs t_asked_ns);
  void send(PageAnswer answer);
  void close();

  boost::beast::tcp_stream stream_;
  PageContext& context_;
  std::unique_ptr<Presence> presence_;
  boost::beast::flat_buffer buffer_;
  std::optional<boost::beast::http::request_parser<boost::beast::http::string_body>> parser_;
  boost::asio::steady_timer timer_;
  Allowance requests_;
  bool keeps_alive_ = false;
};

}  // namespace heel
