#include "operator/web/websocket_sessions.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <atomic>
#include <boost/asio/buffer.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/write.hpp>
#include <utility>

#include "heel/error.h"
#include "operator/web/limits.h"
#include "operator/web/view_json.h"
#include "operator/web/websocket_session.h"
#include "realtime/clock.h"

namespace heel {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;

SharedMessage text_message(std::string text) {
  return std::make_shared<const LiveMessage>(LiveMessage{false, std::move(text)});
}

class LiveSession final : public WebSocketSession, public LiveViewer {
 public:
  using WebSocketSession::WebSocketSession;
  ~LiveSession() override { context().hub.remove(*this); }

  void send(SharedMessage message) override { send_message(std::move(message)); }

 private:
  void opened() override {
    if (!context().hub.add(*this)) drop();
  }
  bool heard(const std::string& text) override { return context().hub.heard(*this, text); }
  void ended() override { context().hub.remove(*this); }
};

/// Between a browser and the operator thread, which serves it as it serves the clients of the local socket.
class OperatorSession final : public WebSocketSession {
 public:
  OperatorSession(beast::tcp_stream&& stream, PageContext& context, std::unique_ptr<Presence> presence)
      : WebSocketSession(std::move(stream), context, std::move(presence)), operators_(context.io) {
    ++this->context().page_operators;
  }
  ~OperatorSession() override { --context().page_operators; }

 private:
  static constexpr std::size_t kMaxLineBytes = 256 * 1024;  // a status has a few thousand

  void opened() override;
  bool heard(const std::string& text) override;
  void ended() override {
    beast::error_code ignored;
    operators_.close(ignored);
  }
  std::shared_ptr<OperatorSession> self() {
    return std::static_pointer_cast<OperatorSession>(shared_from_this());
  }
  void read_answers();
  void write_requests();
  std::string login(const ViewJson& request);

  asio::local::stream_protocol::socket operators_;
  const std::shared_ptr<std::atomic<bool>> may_write_ = std::make_shared<std::atomic<bool>>(false);
  std::string answers_;           // bytes from the operator thread
  std::string requests_, going_;  // bytes to it: those that wait, and those on their way
};

void OperatorSession::opened() {
  try {
    const int fd = context().operators->invite("page, " + address(), may_write_);
    operators_.assign(asio::local::stream_protocol(), fd);
  } catch (const Error& error) {
    context().warn(error.what());
    drop();
    return;
  }
  read_answers();
}

bool OperatorSession::heard(const std::string& text) {
  std::string line = text;
  // In JSON an end of line stands for a blank; to the operator thread it would end the request.
  std::replace_if(
      line.begin(), line.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  const ViewJson request = ViewJson::parse(line, nullptr, /*allow_exceptions=*/false);
  if (request.is_object() && request.value("do", ViewJson()) == "login") {
    send_message(text_message(login(request)));
    return true;
  }
  if (requests_.size() > kMaxLineBytes) return false;
  requests_ += line + '\n';
  if (going_.empty()) write_requests();
  return true;
}

void OperatorSession::write_requests() {
  going_.swap(requests_);
  asio::async_write(operators_, asio::buffer(going_), [self = self()](beast::error_code error, std::size_t) {
    self->going_.clear();
    if (!error && !self->requests_.empty()) self->write_requests();
  });
}

void OperatorSession::read_answers() {
  asio::async_read_until(operators_, asio::dynamic_buffer(answers_, kMaxLineBytes), '\n',
                         [self = self()](beast::error_code error, std::size_t count) {
                           if (error) {
                             self->drop();
                             return;
                           }
                           self->send_message(text_message(self->answers_.substr(0, count - 1)));
                           self->answers_.erase(0, count);
                           self->read_answers();
                         });
}

std::string OperatorSession::login(const ViewJson& request) {
  const auto answer = [&](const char* name, const ViewJson& value, bool ok) {
    ViewJson out = {{"v", kProtocolVersion}};
    if (request.contains("id") && request["id"].is_number_integer()) out["id"] = request["id"];
    out["ok"] = ok;
    out[name] = value;
    return text_of(out);
  };
  if (!context().token.set())
    return answer("error", "heeld has no token (view.token_file): nothing can be changed over the network",
                  false);
  const std::string counted = counted_address(address());
  const TimeNs now_ns = monotonic_now_ns();
  if (!context().limits.may_try_token(counted, now_ns)) {
    context().warn(address() + ": too many tokens were tried; it is refused for a minute");
    return answer("error", "too many tokens were tried (expected at most 5 a minute)", false);
  }
  const ViewJson token = request.value("token", ViewJson());
  if (!token.is_string() || !context().token.equals(token.get_ref<const std::string&>())) {
    context().warn(address() + ": a wrong token was tried");
    return answer("error", "not the token of this heeld", false);
  }
  context().limits.token_was_right(counted, now_ns);
  spdlog::info("page: {} has said the token", address());
  may_write_->store(true, std::memory_order_release);
  return answer("may_write", true, true);
}

template <typename Session>
void open_session(beast::tcp_stream&& stream, PageContext& context, std::unique_ptr<Presence> presence,
                  UpgradeRequest request) {
  std::make_shared<Session>(std::move(stream), context, std::move(presence))->start(std::move(request));
}

}  // namespace

void open_live_session(beast::tcp_stream&& stream, PageContext& context, std::unique_ptr<Presence> presence,
                       UpgradeRequest request) {
  open_session<LiveSession>(std::move(stream), context, std::move(presence), std::move(request));
}

void open_operator_session(beast::tcp_stream&& stream, PageContext& context,
                           std::unique_ptr<Presence> presence, UpgradeRequest request) {
  open_session<OperatorSession>(std::move(stream), context, std::move(presence), std::move(request));
}

}  // namespace heel
