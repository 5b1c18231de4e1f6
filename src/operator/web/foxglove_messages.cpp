#include "operator/web/foxglove_messages.h"

#include <array>
#include <utility>

#include "config/config_table.h"
#include "operator/web/config_json.h"

namespace heel {
namespace {

constexpr std::array<std::string_view, 2> kProtocols{"foxglove.sdk.v1", "foxglove.websocket.v1"};
constexpr std::array kLiveTopics{Topic::Tick,    Topic::Pose,      Topic::Log,
                                 Topic::Picture, Topic::Transform, Topic::Person};

void append_little_endian(std::string& bytes, std::uint64_t value, int count) {
  for (int byte = 0; byte < count; ++byte) bytes += static_cast<char>(value >> (8 * byte) & 255);
}

}  // namespace

std::string foxglove_protocol(std::string_view offered) {
  const std::string list = "," + std::string(offered) + ",";
  for (const std::string_view ours : kProtocols) {
    const std::size_t place = list.find(ours);
    if (place == std::string::npos) continue;
    const char before = list[place - 1], after = list[place + ours.size()];
    if ((before == ',' || before == ' ') && (after == ',' || after == ' ')) return std::string(ours);
  }
  return "";
}

std::span<const Topic> live_topics() {
  return kLiveTopics;
}

std::string foxglove_server_info() {
  return text_of({{"op", "serverInfo"},
                  {"name", "heeld"},
                  {"capabilities", {"parameters", "parametersSubscribe"}},
                  {"supportedEncodings", {"json"}},
                  {"metadata", ViewJson::object()}});
}

std::string foxglove_advertise() {
  ViewJson channels = ViewJson::array();
  for (const Topic topic : kLiveTopics) {
    const TopicRow& row = topic_table()[static_cast<std::size_t>(topic)];
    channels.push_back({{"id", static_cast<int>(topic)},
                        {"topic", row.name},
                        {"encoding", "json"},
                        {"schemaName", row.schema},
                        {"schemaEncoding", "jsonschema"},
                        {"schema", row.schema_text()}});
  }
  return text_of({{"op", "advertise"}, {"channels", std::move(channels)}});
}

std::string foxglove_parameters(const Config& config, std::span<const std::string> names,
                                const std::string& id) {
  ViewJson parameters = ViewJson::array();
  const auto add = [&](const ConfigKey& key) {
    parameters.push_back({{"name", key.full_name()}, {"value", config_value_json(key, config)}});
    if (key.field.index() == 2) parameters.back()["type"] = "float64";  // 1.0 stays a real number
  };
  for (const std::string& name : names)
    if (const auto index = index_of_key(name)) add(config_keys()[*index]);
  if (names.empty())
    for (const ConfigKey& key : config_keys()) add(key);
  ViewJson out = {{"op", "parameterValues"}, {"parameters", std::move(parameters)}};
  if (!id.empty()) out["id"] = id;
  return text_of(out);
}

std::string foxglove_status(int level, const std::string& text) {
  return text_of({{"op", "status"}, {"level", level}, {"message", text}});
}

std::string foxglove_data(std::uint32_t subscription, TimeNs t_log_ns, std::string_view message) {
  std::string bytes(1, '\1');
  bytes.reserve(13 + message.size());
  append_little_endian(bytes, subscription, 4);
  append_little_endian(bytes, static_cast<std::uint64_t>(t_log_ns), 8);
  return bytes.append(message);
}

std::string set_request(const ViewJson& parameters, std::int64_t id) {
  ViewJson values = ViewJson::object();
  if (!parameters.is_array()) return "";
  for (const ViewJson& one : parameters) {
    if (!one.is_object() || !one.value("name", ViewJson()).is_string()) return "";
    values[one["name"].get<std::string>()] = one.value("value", ViewJson());
  }
  if (values.empty()) return "";
  return text_of({{"do", "set"}, {"id", id}, {"values", std::move(values)}});
}

}  // namespace heel
