#include "recording/redacted_message.h"

#include <map>
#include <nlohmann/json.hpp>
#include <vector>

namespace heel {
namespace {

constexpr std::string_view kConfigurationTopic = "/heel/configuration";

const std::map<std::string_view, std::vector<const char*>>& members_with_text() {
  static const std::map<std::string_view, std::vector<const char*>> members{
      {"/log", {"message"}},
      {kConfigurationTopic, {"text"}},
      {"/heel/operator", {"who", "request", "answer"}},
      {"/heel/recording", {"text"}},
      {"/heel/event", {"text"}}};
  return members;
}

}  // namespace

std::string redacted_message(const Redaction& redaction, std::string_view topic, std::string_view json) {
  const auto members = members_with_text().find(topic);
  if (members == members_with_text().end()) return std::string(json);
  using Message = nlohmann::ordered_json;
  Message message = Message::parse(json, nullptr, /*allow_exceptions=*/false);
  if (!message.is_object()) return redaction.applied(json);
  for (const char* const name : members->second) {
    const auto member = message.find(name);
    if (member == message.end() || !member->is_string()) continue;
    const auto& text = member->get_ref<const std::string&>();
    *member = topic == kConfigurationTopic ? redaction.applied_to_toml(text) : redaction.applied(text);
  }
  return message.dump(-1, ' ', false, Message::error_handler_t::replace);
}

}  // namespace heel
