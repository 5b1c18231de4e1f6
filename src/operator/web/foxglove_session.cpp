// A connection of Foxglove or Lichtblick: topics that it subscribes to, as a recording has them, and the keys
// of the configuration as parameters.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <boost/beast/core/tcp_stream.hpp>
#include <charconv>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "config/config_set.h"
#include "heel/error.h"
#include "operator/web/foxglove_messages.h"
#include "operator/web/limits.h"
#include "operator/web/operator_link.h"
#include "operator/web/wall_clock.h"
#include "operator/web/websocket_session.h"
#include "operator/web/websocket_sessions.h"
#include "realtime/clock.h"
#include "recording/flow_json.h"
#include "recording/picture.h"
#include "recording/records.h"
#include "recording/viewer_messages.h"

namespace heel {
namespace {

constexpr std::size_t kBusyBytes = 128 * 1024;  // with more that waits, nothing but the log is sent
constexpr std::size_t kMaxSubscriptions = 64;

class FoxgloveSession final : public WebSocketSession, public RecordViewer {
 public:
  FoxgloveSession(boost::beast::tcp_stream&& stream, PageContext& context, std::unique_ptr<Presence> presence,
                  std::string token)
      : WebSocketSession(std::move(stream), context, std::move(presence)),
        token_(std::move(token)),
        operators_(context.io) {}
  ~FoxgloveSession() override { context().hub.remove(*this); }

  bool wants_pictures() const override { return subscribed(Topic::Picture); }
  bool ready_for_picture() const override { return wants_pictures() && waiting_bytes() < kBusyBytes; }
  void see(const LiveNews& news, const std::string& jpeg, const std::vector<LoggedLine>& lines) override;

 private:
  void opened() override;
  bool heard(const std::string& text) override;
  void ended() override {
    context().hub.remove(*this);
    operators_.close();
  }
  bool subscribed(Topic topic) const;
  bool subscribe(const ViewJson& list);
  bool unsubscribe(const ViewJson& list);
  void send_parameters(const ViewJson& request);
  void send_parameters_of(const ViewJson& set);
  void set_parameters(const ViewJson& request);
  void was_set(const std::string& answer);
  void send_changed_parameters();
  void say(std::string text);
  void publish(Topic topic, TimeNs t_log_ns, const std::string& message);

  const std::string token_;  // of the request's address; empty: none
  OperatorLink operators_;
  const std::shared_ptr<std::atomic<bool>> may_write_ = std::make_shared<std::atomic<bool>>(false);
  std::map<std::uint32_t, Topic> subscriptions_;  // by their numbers
  bool follows_parameters_ = false;
  Config parameters_;                      // as the viewer knows them
  std::map<std::int64_t, ViewJson> sets_;  // that wait for their answer, by number
  std::int64_t sets_so_far_ = 0;
};

void FoxgloveSession::opened() {
  if (!context().hub.add(static_cast<RecordViewer&>(*this))) {
    drop();
    return;
  }
  say(foxglove_server_info());
  say(foxglove_advertise());
  if (token_.empty() || context().operators == nullptr) return;
  const std::string error = try_token(context(), address(), token_);
  if (!error.empty()) {
    say(foxglove_status(2, error));
    return;
  }
  may_write_->store(true, std::memory_order_release);
  try {
    operators_.open(
        context().operators->invite("foxglove, " + address(), may_write_),
        {shared_from_this(), [this](const std::string& line) { was_set(line); }, [this] { drop(); }});
  } catch (const Error& failed) {
    context().warn(failed.what());
    drop();
  }
}

bool FoxgloveSession::heard(const std::string& text) {
  const ViewJson message = ViewJson::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!message.is_object()) return false;
  const ViewJson op = message.value("op", ViewJson());
  if (op == "subscribe") return subscribe(message.value("subscriptions", ViewJson()));
  if (op == "unsubscribe") return unsubscribe(message.value("subscriptionIds", ViewJson()));
  if (op == "getParameters") {
    send_parameters(message);
  } else if (op == "setParameters") {
    set_parameters(message);
  } else if (op == "subscribeParameterUpdates" || op == "unsubscribeParameterUpdates") {
    follows_parameters_ = op == "subscribeParameterUpdates";
    parameters_ = context().settings.view().in_use;
  } else {
    say(foxglove_status(1, "heeld does not serve this: " + text.substr(0, 100)));
  }
  return true;
}

bool FoxgloveSession::subscribed(Topic topic) const {
  return std::any_of(subscriptions_.begin(), subscriptions_.end(),
                     [topic](const auto& one) { return one.second == topic; });
}

bool FoxgloveSession::subscribe(const ViewJson& list) {
  if (!list.is_array()) return false;
  for (const ViewJson& one : list) {
    const ViewJson id = one.is_object() ? one.value("id", ViewJson()) : ViewJson();
    const ViewJson channel = one.is_object() ? one.value("channelId", ViewJson()) : ViewJson();
    if (!id.is_number_unsigned() || !channel.is_number_unsigned()) return false;
    for (const Topic topic : live_topics())
      if (channel == static_cast<unsigned>(topic) && subscriptions_.size() < kMaxSubscriptions)
        subscriptions_[id.get<std::uint32_t>()] = topic;
  }
  context().hub.asked();
  return true;
}

bool FoxgloveSession::unsubscribe(const ViewJson& list) {
  if (!list.is_array()) return false;
  for (const ViewJson& id : list)
    if (id.is_number_unsigned()) subscriptions_.erase(id.get<std::uint32_t>());
  context().hub.asked();
  return true;
}

void FoxgloveSession::send_parameters(const ViewJson& request) {
  std::vector<std::string> names;
  const ViewJson list = request.value("parameterNames", ViewJson());
  if (list.is_array())
    for (const ViewJson& name : list)
      if (name.is_string()) names.push_back(name.get<std::string>());
  const ViewJson id = request.value("id", ViewJson());
  say(foxglove_parameters(context().settings.view().in_use, names,
                          id.is_string() ? id.get<std::string>() : ""));
}

/// After a setParameters, done or not: the viewer shows what it has asked for until it is told otherwise.
void FoxgloveSession::send_parameters_of(const ViewJson& set) {
  ViewJson request = {{"parameterNames", ViewJson::array()}};
  for (const ViewJson& one : set["parameters"]) request["parameterNames"].push_back(one["name"]);
  if (set.contains("id")) request["id"] = set["id"];
  send_parameters(request);
}

/// Through the operator thread, as `heel set`: the same bounds, the same answers, the same record.
void FoxgloveSession::set_parameters(const ViewJson& request) {
  const std::string line = set_request(request.value("parameters", ViewJson()), sets_so_far_ + 1);
  if (line.empty()) {
    say(foxglove_status(2, "setParameters: no parameter with a name"));
    return;
  }
  if (!may_write_->load(std::memory_order_acquire)) {
    say(foxglove_status(2, "not allowed without the token (expected ws://…/foxglove?token=TOKEN)"));
  } else if (operators_.send(line)) {
    sets_[++sets_so_far_] = request;
    return;
  }
  send_parameters_of(request);
}

void FoxgloveSession::was_set(const std::string& line) {
  const ViewJson answer = ViewJson::parse(line, nullptr, /*allow_exceptions=*/false);
  const auto asked = sets_.find(answer.value("id", std::int64_t{0}));
  if (answer.value("ok", false) == false) say(foxglove_status(2, answer.value("error", "not done")));
  if (asked == sets_.end()) return;
  send_parameters_of(asked->second);
  sets_.erase(asked);
}

void FoxgloveSession::send_changed_parameters() {
  const Config now = context().settings.view().in_use;
  std::vector<std::string> names;
  for (const ConfigChange& change : changes_between(parameters_, now)) names.push_back(change.key);
  if (!names.empty()) say(foxglove_parameters(now, names, ""));
  parameters_ = now;
}

void FoxgloveSession::see(const LiveNews& news, const std::string& jpeg,
                          const std::vector<LoggedLine>& lines) {
  const TimeNs wall_minus_monotonic_ns = wall_now_ns() - monotonic_now_ns();
  if (follows_parameters_) send_changed_parameters();
  for (const LoggedLine& line : lines)
    publish(Topic::Log, line.t_wall_ns, log_json({0, line.text}, line.t_wall_ns));
  // Late records are worth less than new ones.
  if (waiting_bytes() > kBusyBytes) return;
  std::string json;
  if (news.tick) {
    const TimeNs t_log_ns = news.tick->input.now_ns + wall_minus_monotonic_ns;
    append_flow_json(json, *news.tick);
    publish(Topic::Tick, t_log_ns, json);
    for (const auto& [topic, append] : {std::pair(Topic::Transform, &append_robot_transform),
                                        std::pair(Topic::Person, &append_person_pose)}) {
      json.clear();
      append(json, *news.tick, t_log_ns);
      if (!json.empty()) publish(topic, t_log_ns, json);
    }
  }
  for (const PoseNews& one : news.poses) {
    json.clear();
    append_flow_json(json, one.pose);
    publish(Topic::Pose, one.pose.t_done_ns + wall_minus_monotonic_ns, json);
  }
  if (jpeg.empty() || !subscribed(Topic::Picture)) return;
  json.clear();
  const TimeNs t_log_ns = news.picture->header.t_capture_ns + wall_minus_monotonic_ns;
  append_picture_json(json, {news.picture->header, "jpeg", jpeg}, t_log_ns);
  publish(Topic::Picture, t_log_ns, json);
}

void FoxgloveSession::say(std::string text) {
  send_message(std::make_shared<const LiveMessage>(LiveMessage{false, std::move(text)}));
}

void FoxgloveSession::publish(Topic topic, TimeNs t_log_ns, const std::string& message) {
  for (const auto& [number, wanted] : subscriptions_) {
    if (wanted != topic) continue;
    send_message(
        std::make_shared<const LiveMessage>(LiveMessage{true, foxglove_data(number, t_log_ns, message)}));
  }
}

/// What stands after "token=" in the address that is asked for; "%20" there is a space.
std::string token_in(std::string_view target) {
  const std::size_t place = target.find("token=");
  if (place == std::string_view::npos) return "";
  const std::string_view rest = target.substr(place + 6), written = rest.substr(0, rest.find('&'));
  std::string token;
  for (std::size_t i = 0; i < written.size(); ++i) {
    unsigned byte = 0;
    const char* const end = written.data() + std::min(i + 3, written.size());
    const bool coded = written[i] == '%' && i + 2 < written.size() &&
                       std::from_chars(written.data() + i + 1, end, byte, 16).ptr == end;
    token += coded ? static_cast<char>(byte) : written[i];
    if (coded) i += 2;
  }
  return token;
}

}  // namespace

void open_foxglove_session(boost::beast::tcp_stream&& stream, PageContext& context,
                           std::unique_ptr<Presence> presence, UpgradeRequest request,
                           const std::string& protocol) {
  const std::string token = token_in({request.target().data(), request.target().size()});
  std::make_shared<FoxgloveSession>(std::move(stream), context, std::move(presence), token)
      ->start(std::move(request), protocol);
}

}  // namespace heel
