// A BrokerLine by Eclipse Paho's synchronous client (MQTT 3.1.1, clean sessions, nothing stored). Without its
// callbacks the library starts no thread: it works while serve() waits.
#pragma once

#include <MQTTClient.h>

#include <string>

#include "operator/mqtt/broker_line.h"

namespace heel {

class PahoLine final : public BrokerLine {
 public:
  explicit PahoLine(BrokerLogin login) : login_(std::move(login)) {}
  ~PahoLine() override { close(); }

  std::string connect() override;
  bool publish(const std::string& topic, const std::string& text) override;
  bool confirmed() override;
  bool serve(TimeNs wait_ns) override;
  void disconnect() override;

 private:
  void close();
  std::string reason_of(int code, bool in_time) const;

  const BrokerLogin login_;
  MQTTClient client_ = nullptr;  // null: none
  std::string tls_problem_;      // of the last attempt
};

}  // namespace heel
