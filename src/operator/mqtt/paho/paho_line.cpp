#include "operator/mqtt/paho/paho_line.h"

#include <fmt/format.h>

#include <chrono>
#include <cstddef>
#include <utility>

#include "operator/mqtt/paho/reachable.h"

namespace heel {
namespace {

constexpr int kKeepAlive_s = 5;  // a broker that is silent for twice as long is gone
constexpr int kConnectTimeout_s = static_cast<int>(kBrokerPatience_ns / kNsPerS);
constexpr int kQos = 1;

/// The library's callback: lines of text about what OpenSSL refused.
int note_tls_problem(const char* text, std::size_t length, void* noted) {
  std::string& problem = *static_cast<std::string*>(noted);
  if (problem.empty()) problem.assign(text, length);
  problem.erase(problem.find_last_not_of(" \r\n") + 1);
  return 1;  // go on
}

}  // namespace

std::string PahoLine::connect() {
  close();
  const int made = MQTTClient_create(&client_, login_.address.c_str(), login_.client.c_str(),
                                     MQTTCLIENT_PERSISTENCE_NONE, nullptr);
  if (made != MQTTCLIENT_SUCCESS) return fmt::format("refused by the MQTT library, error {}", made);

  MQTTClient_willOptions will = MQTTClient_willOptions_initializer;
  will.topicName = login_.will_topic.c_str();
  will.message = login_.will.c_str();
  will.qos = kQos;
  will.retained = 1;
  MQTTClient_SSLOptions tls = MQTTClient_SSLOptions_initializer;
  tls.trustStore = login_.ca_file.empty() ? nullptr : login_.ca_file.c_str();
  tls.verify = 1;  // the certificate must be that of the host
  tls.ssl_error_cb = note_tls_problem;
  tls.ssl_error_context = &tls_problem_;
  MQTTClient_connectOptions options = MQTTClient_connectOptions_initializer;
  options.MQTTVersion = MQTTVERSION_3_1_1;  // a broker that does not know it is not asked for 3.1
  options.keepAliveInterval = kKeepAlive_s;
  options.connectTimeout = kConnectTimeout_s;
  options.cleansession = 1;
  options.reliable = 0;  // publish() must not wait for the confirmation of the message before
  options.will = &will;
  if (!login_.user.empty()) options.username = login_.user.c_str();
  if (!login_.password.empty()) options.password = login_.password.c_str();
  if (login_.address.starts_with("ssl://")) options.ssl = &tls;

  tls_problem_.clear();
  const auto begin = std::chrono::steady_clock::now();
  const int code = MQTTClient_connect(client_, &options);
  if (code == MQTTCLIENT_SUCCESS) return "";
  const auto taken = std::chrono::steady_clock::now() - begin;
  close();
  return reason_of(code, taken < std::chrono::nanoseconds(kBrokerPatience_ns));
}

std::string PahoLine::reason_of(int code, bool in_time) const {
  switch (code) {  // of the broker, MQTT 3.1.1, table 3.1; mosquitto answers 5 to a wrong password
    case 1:
      return "the broker does not know MQTT 3.1.1";
    case 2:
      return fmt::format("the broker refuses the client name '{}' (mqtt.topic)", login_.client);
    case 3:
      return "the broker says that it is not available";
    case 4:
    case 5:
      return "the broker refuses this user or password (expected the mqtt.user and mqtt.password_file that "
             "it knows)";
    default:
      break;
  }
  if (!tls_problem_.empty())
    return fmt::format("no TLS connection: {} (expected a certificate of mqtt.ca_file for this host name)",
                       tls_problem_);
  const std::string unreachable = why_unreachable(login_.address);
  if (!unreachable.empty()) return unreachable;
  return in_time ? "the connection is closed at once (expected an MQTT broker; one with TLS is ssl://)"
                 : fmt::format("does not answer as an MQTT broker within {} s", kConnectTimeout_s);
}

bool PahoLine::publish(const std::string& topic, const std::string& text) {
  MQTTClient_deliveryToken token = 0;
  return MQTTClient_publish(client_, topic.c_str(), static_cast<int>(text.size()), text.data(), kQos,
                            /*retained=*/1, &token) == MQTTCLIENT_SUCCESS;
}

bool PahoLine::confirmed() {
  MQTTClient_deliveryToken* pending = nullptr;
  const bool known = MQTTClient_getPendingDeliveryTokens(client_, &pending) == MQTTCLIENT_SUCCESS;
  const bool none = pending == nullptr;
  MQTTClient_free(pending);
  return known && none;
}

bool PahoLine::serve(TimeNs wait_ns) {
  char* topic = nullptr;
  int topic_bytes = 0;
  MQTTClient_message* message = nullptr;
  const auto wait_ms = static_cast<unsigned long>(wait_ns / kNsPerMs);
  const int code = MQTTClient_receive(client_, &topic, &topic_bytes, &message, wait_ms);
  if (message != nullptr) {  // of a broker that sends what nobody has subscribed to
    MQTTClient_freeMessage(&message);
    MQTTClient_free(topic);
  }
  return (code == MQTTCLIENT_SUCCESS || code == MQTTCLIENT_TOPICNAME_TRUNCATED) &&
         MQTTClient_isConnected(client_) != 0;
}

void PahoLine::disconnect() {
  if (client_ != nullptr) MQTTClient_disconnect(client_, /*timeout_ms=*/0);
  close();
}

void PahoLine::close() {
  if (client_ != nullptr) MQTTClient_destroy(&client_);
  client_ = nullptr;
}

}  // namespace heel
