#include "operator/web/websocket_session.h"

#include <fmt/format.h>

#include <boost/asio/buffer.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/websocket/error.hpp>
#include <chrono>
#include <utility>

#include "operator/web/limits.h"
#include "realtime/clock.h"

namespace heel {
namespace {

namespace beast = boost::beast;
namespace websocket = beast::websocket;

}  // namespace

WebSocketSession::WebSocketSession(beast::tcp_stream&& stream, PageContext& context,
                                   std::unique_ptr<Presence> presence)
    : stream_(std::move(stream)),
      context_(context),
      presence_(std::move(presence)),
      buffer_(kMaxMessageBytes),
      messages_(kPageRequestsPerS, kPageRequestsPerS) {
  websocket::stream_base::timeout times{};
  times.handshake_timeout = std::chrono::nanoseconds(kRequestTime_ns);
  times.idle_timeout = std::chrono::nanoseconds(kSilence_ns);
  times.keep_alive_pings = true;
  stream_.set_option(times);
  stream_.read_message_max(kMaxMessageBytes);
  stream_.auto_fragment(false);  // a picture is one frame, and one write
}

void WebSocketSession::start(UpgradeRequest request, const std::string& protocol) {
  if (!protocol.empty())
    stream_.set_option(websocket::stream_base::decorator([protocol](websocket::response_type& response) {
      response.set(beast::http::field::sec_websocket_protocol, protocol);
    }));
  const auto kept = std::make_shared<UpgradeRequest>(std::move(request));
  stream_.async_accept(*kept, [self = shared_from_this(), kept](beast::error_code error) {
    if (error) return;
    beast::error_code ignored;
    beast::get_lowest_layer(self->stream_).socket().set_option(boost::asio::ip::tcp::no_delay(true), ignored);
    beast::get_lowest_layer(self->stream_)
        .socket()
        .set_option(boost::asio::socket_base::send_buffer_size(kSendBufferBytes), ignored);
    self->opened();
    self->read();
  });
}

void WebSocketSession::read() {
  stream_.async_read(buffer_, [self = shared_from_this()](beast::error_code error, std::size_t) {
    if (!error) {
      self->read_done();
      return;
    }
    self->closed_ = true;
    self->ended();
  });
}

void WebSocketSession::read_done() {
  const std::string text = beast::buffers_to_string(buffer_.data());
  buffer_.consume(buffer_.size());
  if (!stream_.got_text()) {
    refuse("a binary message (expected text)");
  } else if (!messages_.take(monotonic_now_ns())) {
    refuse(fmt::format("too many messages (expected at most {} a second)", kPageRequestsPerS));
  } else if (!heard(text)) {
    refuse("not a message that is known");
  }
  if (!closed_) read();
}

void WebSocketSession::refuse(const std::string& why) {
  context_.warn(fmt::format("{}: closed: {}", address(), why));
  drop();
}

void WebSocketSession::send_message(SharedMessage message) {
  if (closed_) return;
  waiting_bytes_ += message->bytes.size();
  waiting_.push_back(std::move(message));
  if (waiting_bytes_ > kMaxWaitingBytes) {
    context_.warn(fmt::format("{}: closed: it does not read what it gets", address()));
    drop();
  } else if (waiting_.size() == 1) {
    write();
  }
}

void WebSocketSession::write() {
  stream_.binary(waiting_.front()->binary);
  stream_.async_write(boost::asio::buffer(waiting_.front()->bytes),
                      [self = shared_from_this()](beast::error_code error, std::size_t) {
                        if (error) return;
                        self->waiting_bytes_ -= self->waiting_.front()->bytes.size();
                        self->waiting_.pop_front();
                        if (!self->waiting_.empty() && !self->closed_) self->write();
                      });
}

/// What reads and writes ends with an error, and with it the session.
void WebSocketSession::drop() {
  closed_ = true;
  beast::get_lowest_layer(stream_).close();
  ended();
}

}  // namespace heel
