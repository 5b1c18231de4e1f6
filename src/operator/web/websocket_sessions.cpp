#include "operator/web/websocket_sessions.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <utility>

#include "heel/error.h"
#include "operator/web/operator_link.h"
#include "operator/web/view_json.h"
#include "operator/web/websocket_session.h"

namespace heel {
namespace {

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
  void opened() override;
  bool heard(const std::string& text) override;
  void ended() override { operators_.close(); }
  std::string login(const ViewJson& request);

  OperatorLink operators_;
  const std::shared_ptr<std::atomic<bool>> may_write_ = std::make_shared<std::atomic<bool>>(false);
};

void OperatorSession::opened() {
  try {
    operators_.open(
        context().operators->invite("page, " + address(), may_write_),
        {shared_from_this(), [this](const std::string& line) { send_message(text_message(line)); },
         [this] { drop(); }});
  } catch (const Error& error) {
    context().warn(error.what());
    drop();
  }
}

bool OperatorSession::heard(const std::string& text) {
  std::string line = text;
  // In JSON an end of line stands for a blank; to the operator thread it would end the request.
  std::replace_if(
      line.begin(), line.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  const ViewJson request = ViewJson::parse(line, nullptr, /*allow_exceptions=*/false);
  if (!request.is_object() || request.value("do", ViewJson()) != "login") return operators_.send(line);
  send_message(text_message(login(request)));
  return true;
}

std::string OperatorSession::login(const ViewJson& request) {
  const auto answer = [&](const char* name, const ViewJson& value, bool ok) {
    ViewJson out = {{"v", kProtocolVersion}};
    if (request.contains("id") && request["id"].is_number_integer()) out["id"] = request["id"];
    out["ok"] = ok;
    out[name] = value;
    return text_of(out);
  };
  const ViewJson token = request.value("token", ViewJson());
  const std::string error =
      try_token(context(), address(), token.is_string() ? token.get<std::string>() : "");
  if (!error.empty()) return answer("error", error, false);
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
