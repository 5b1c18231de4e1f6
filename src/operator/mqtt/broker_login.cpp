#include "operator/mqtt/broker_login.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <string_view>

#include "heel/error.h"
#include "operator/secret_file.h"

namespace heel {
namespace {

/// This computer's name, as one level of a topic.
std::string host_level() {
  std::array<char, 256> name{};
  if (gethostname(name.data(), name.size() - 1) != 0 || name[0] == '\0') return "robot";
  std::string level(name.data());
  std::replace_if(
      level.begin(), level.end(), [](char c) { return std::strchr("+#/", c) != nullptr; }, '-');
  return level;
}

}  // namespace

std::string mqtt_topic(const MqttConfig& config) {
  constexpr std::string_view kHost = "{host}";
  std::string topic = config.topic;
  const std::size_t at = topic.find(kHost);
  if (at != std::string::npos) topic.replace(at, kHost.size(), host_level());
  return topic;
}

BrokerLogin broker_login(const MqttConfig& config) {
  const std::string topic = mqtt_topic(config);
  BrokerLogin login{.address = config.address,
                    .client = topic,
                    .user = config.user,
                    .password = {},
                    .ca_file = config.ca_file,
                    .will_topic = topic + "/online",
                    .will = "offline"};
  if (!config.user.empty())
    login.password = read_secret(config.password_file, {.key = "mqtt.password_file",
                                                        .what = "password of mqtt.user",
                                                        .credential = "mqtt-password",
                                                        .how_to_make = {}});
  if (!config.ca_file.empty() && !std::ifstream(config.ca_file))
    throw Error(fmt::format("mqtt.ca_file: {}: cannot be read: {} (expected a file of certificates, PEM)",
                            config.ca_file, std::strerror(errno)));
  return login;
}

std::string mqtt_exposure(const MqttConfig& config) {
  if (config.address.empty()) return "";
  const BrokerLogin login = broker_login(config);
  const bool encrypted = config.address.starts_with("ssl://");
  const bool this_computer = config.address.starts_with("tcp://127.") ||
                             config.address.starts_with("tcp://[::1]") ||
                             config.address.starts_with("tcp://localhost:");
  const char* const readers =
      encrypted                ? "over TLS"
      : this_computer          ? "on this computer"
      : login.password.empty() ? "without encryption: everybody on its way can read it (docs/how-to/mqtt.md)"
                               : "without encryption: everybody on its way can read it, and the password "
                                 "of mqtt.user (docs/how-to/mqtt.md)";
  return fmt::format("mqtt.address: {}: the status goes to this broker as {}/status, {}", config.address,
                     mqtt_topic(config), readers);
}

}  // namespace heel
