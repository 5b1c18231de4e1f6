#include "operator/web/http_session.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <boost/beast/core/bind_handler.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/write.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <chrono>
#include <string>
#include <utility>

#include "operator/web/foxglove_messages.h"
#include "operator/web/limits.h"
#include "operator/web/view_json.h"
#include "operator/web/websocket_sessions.h"
#include "realtime/clock.h"

namespace heel {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;

constexpr TimeNs kStopLook_ns = 5 * kNsPerMs;

// Scripts, styles and connections from this server alone; pictures may also be made by the page itself.
constexpr const char* kContentPolicy =
    "default-src 'self'; img-src 'self' blob: data:; object-src 'none'; base-uri 'none'; form-action 'self'; "
    "frame-ancestors 'none'";

std::string_view text_of_header(const http::request<http::string_body>& request, const char* name) {
  const auto found = request.find(name);
  return found == request.end() ? std::string_view()
                                : std::string_view(found->value().data(), found->value().size());
}

std::string_view view_of(beast::string_view text) {
  return {text.data(), text.size()};
}

}  // namespace

HttpSession::HttpSession(asio::ip::tcp::socket&& socket, PageContext& context,
                         std::unique_ptr<Presence> presence)
    : stream_(std::move(socket)),
      context_(context),
      presence_(std::move(presence)),
      buffer_(kMaxHeadBytes + kMaxBodyBytes),
      timer_(context.io),
      requests_(kPageRequestsPerS, kPageRequestsPerS) {}

void HttpSession::start() {
  presence_->close = [weak = weak_from_this()] {
    if (const auto session = weak.lock()) session->stream_.close();
  };
  read();
}

void HttpSession::read() {
  parser_.emplace();
  parser_->header_limit(kMaxHeadBytes);
  parser_->body_limit(kMaxBodyBytes);
  stream_.expires_after(std::chrono::nanoseconds(kRequestTime_ns));
  http::async_read(
      stream_, buffer_, *parser_,
      [self = shared_from_this()](beast::error_code error, std::size_t) { self->read_done(error); });
}

void HttpSession::read_done(beast::error_code error) {
  if (error) {
    refuse_bytes(error);
    return;
  }
  presence_->active();
  keeps_alive_ = parser_->get().keep_alive();
  serve();
}

/// What has come is no request, or a part of one.
void HttpSession::refuse_bytes(beast::error_code error) {
  const bool is_http = error.category() == http::make_error_code(http::error::bad_method).category();
  keeps_alive_ = false;
  if (!is_http || error == http::error::end_of_stream || error == http::error::partial_message) {
    close();
  } else if (error == http::error::header_limit) {
    send(page_error(
        431, fmt::format("the head of the request is too long (expected at most {} bytes)", kMaxHeadBytes)));
  } else if (error == http::error::body_limit) {
    send(page_error(
        413, fmt::format("the body of the request is too long (expected at most {} bytes)", kMaxBodyBytes)));
  } else {
    send(page_error(400, "no HTTP request: " + error.message()));
  }
}

void HttpSession::serve() {
  const http::request<http::string_body>& message = parser_->get();
  const PageRequest request{.method = view_of(message.method_string()),
                            .target = view_of(message.target()),
                            .host = text_of_header(message, "Host"),
                            .origin = text_of_header(message, "Origin"),
                            .fetch_site = text_of_header(message, "Sec-Fetch-Site")};
  PageAnswer refused = message.count("Host") == 1 && message.count("Origin") <= 1
                           ? context_.answers.check_site(request)
                           : page_error(400, "Host: missing or there twice (expected it once)");
  if (refused.status != 200) {
    context_.warn(fmt::format("{}: refused: {}", presence_->address(), refused.body));
    keeps_alive_ = false;
    send(std::move(refused));
  } else if (request.method == "POST" && request.target == "/estop") {
    stop_robot();
  } else if (presence_->limited() || !requests_.take(monotonic_now_ns())) {
    keeps_alive_ = false;
    send(page_error(429, "too many connections or requests from this address"));
  } else if (beast::websocket::is_upgrade(message)) {
    become_websocket(request);
  } else {
    send(context_.answers.answer(request));
  }
}

void HttpSession::become_websocket(const PageRequest& request) {
  const std::string_view path = request.target.substr(0, request.target.find('?'));
  PageAnswer refused;
  const bool looks = path == "/live" || path == "/foxglove";
  const std::string protocol = foxglove_protocol(text_of_header(parser_->get(), "Sec-WebSocket-Protocol"));
  if (!looks && path != "/operator") {
    refused = page_error(404, "no WebSocket of this name (expected /live, /operator or /foxglove)");
  } else if (looks && context_.hub.viewers() >= kMaxViewers) {
    refused = page_error(503, fmt::format("{} browsers look already", kMaxViewers));
  } else if (path == "/foxglove" && protocol.empty()) {
    refused = page_error(400, "Sec-WebSocket-Protocol: expected foxglove.sdk.v1 or foxglove.websocket.v1");
  } else if (path == "/operator" && context_.operators == nullptr) {
    refused = page_error(503, "operators are not served (operator.socket is empty)");
  } else if (path == "/operator" && context_.page_operators >= kMaxPageOperators) {
    refused = page_error(503, fmt::format("{} browsers are connected already", kMaxPageOperators));
  } else {
    presence_->close = nullptr;
    stream_.expires_never();
    if (path == "/foxglove") {
      open_foxglove_session(std::move(stream_), context_, std::move(presence_), parser_->release(), protocol);
    } else {
      const auto open = path == "/live" ? open_live_session : open_operator_session;
      open(std::move(stream_), context_, std::move(presence_), parser_->release());
    }
    return;
  }
  keeps_alive_ = false;
  send(std::move(refused));
}

/// The request goes to the control loop at once; what became of it is in the answer, when the loop says so in
/// time.
void HttpSession::stop_robot() {
  const TimeNs now_ns = monotonic_now_ns();
  const OperatorRequest asked = context_.port.request(OperatorCommand::EStop, now_ns);
  if (context_.logged_stops.take(now_ns)) spdlog::info("operator (page, {}): estop", presence_->address());
  stream_.expires_never();
  await_stop(asked.number, now_ns);
}

void HttpSession::await_stop(std::uint64_t request_number, TimeNs t_asked_ns) {
  const TickRecord tick = context_.telemetry.snapshot().tick;
  const bool handled = tick.request_number >= request_number;
  if (handled || monotonic_now_ns() - t_asked_ns > kStopAnswer_ns) {
    const bool newest = tick.request_number == request_number;
    const std::string outcome = !handled ? "sent" : newest ? to_string(tick.outcome) : "done";
    context_.port.answered("page, " + presence_->address(), "estop", outcome);
    send({200, "application/json", text_of({{"ok", true}, {"outcome", outcome}})});
    return;
  }
  timer_.expires_after(std::chrono::nanoseconds(kStopLook_ns));
  timer_.async_wait([self = shared_from_this(), request_number, t_asked_ns](beast::error_code error) {
    if (!error) self->await_stop(request_number, t_asked_ns);
  });
}

void HttpSession::send(PageAnswer answer) {
  auto response = std::make_shared<http::response<http::string_body>>(http::int_to_status(answer.status), 11);
  const auto media_type = answer.media_type;
  response->set(http::field::content_type, {media_type.data(), media_type.size()});
  response->set(http::field::cache_control, answer.is_page ? "no-cache" : "no-store");
  response->set("Content-Security-Policy", kContentPolicy);
  response->set("X-Content-Type-Options", "nosniff");
  response->set("Referrer-Policy", "no-referrer");
  response->set("Cross-Origin-Resource-Policy", "same-origin");
  if (!answer.allow.empty()) response->set(http::field::allow, {answer.allow.data(), answer.allow.size()});
  response->keep_alive(keeps_alive_);
  const bool head_only = parser_->is_header_done() && parser_->get().method() == http::verb::head;
  response->content_length(answer.body.size());
  if (!head_only) response->body() = std::move(answer.body);
  stream_.expires_after(std::chrono::nanoseconds(kAnswerTime_ns));
  http::async_write(stream_, *response,
                    [self = shared_from_this(), response](beast::error_code error, std::size_t) {
                      if (error || !self->keeps_alive_) {
                        self->close();
                      } else {
                        self->read();
                      }
                    });
}

void HttpSession::close() {
  beast::error_code ignored;
  stream_.socket().shutdown(asio::ip::tcp::socket::shutdown_send, ignored);
  stream_.close();
}

}  // namespace heel
