// The loop of the MQTT thread: the status, as `heel status --json` gives it, goes to a broker. It is no
// real-time thread, and reads the newest tick that telemetry has kept: the broker cannot delay anything.
// Nothing is subscribed to, so that no command can come from there.
//
//   TOPIC/status   the status: with every change of the state or of a reason, and every mqtt.period_s
//   TOPIC/online   "online"; "offline" when heeld ends, also when it or its computer is killed
//
// Both are retained, QoS 1. One message at a time is on its way; what is published next is the status of
// then.
//
//   MqttPublisher publisher(config.mqtt, {settings, telemetry, port});  // loads mqtt.so; throws heel::Error
//   std::thread thread([&] { publisher.run(); });
//   …  publisher.stop(); thread.join();
#pragma once

#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>

#include "core/config.h"
#include "heel/flow.h"
#include "operator/mqtt/broker_line.h"
#include "operator/mqtt/retry.h"
#include "operator/operator_port.h"
#include "operator/settings.h"
#include "telemetry/telemetry.h"

namespace heel {

/// What the status is made of. All is borrowed.
struct MqttParts {
  const Settings& settings;
  const Telemetry& telemetry;
  OperatorPort& port;
};

class MqttPublisher {
 public:
  MqttPublisher(const MqttConfig& config, const MqttParts& parts);
  /// With a line that is there already.
  MqttPublisher(const MqttConfig& config, const MqttParts& parts, std::unique_ptr<BrokerLine> line);

  /// Until stop().
  void run();
  /// From any thread.
  void stop();

 private:
  bool pause(TimeNs pause_ns);
  void step();
  void connect();
  void serve();
  void publish();
  bool status_is_due(const TickRecord& newest, TimeNs now_ns) const;
  std::string status_text(const TelemetrySnapshot& newest, TimeNs now_ns) const;
  void lost(const std::string& reason);
  void leave();

  const std::string address_, topic_, exposure_;
  const TimeNs period_ns_;
  const MqttParts parts_;
  const std::unique_ptr<BrokerLine> line_;

  Backoff backoff_;
  ReasonsSeen reasons_;
  bool tell_connected_ = true;  // it was not logged since the last failure that was
  bool connected_ = false;
  bool stable_ = false;     // this connection was no accident
  bool announced_ = false;  // "online" was published over it
  TimeNs t_connected_ns_ = 0;
  TimeNs t_published_ns_ = 0;  // 0: no status yet over it
  TickRecord published_;       // the newest tick of that status

  std::mutex mutex_;
  std::condition_variable stopped_;
  bool stop_ = false;  // guarded by mutex_
};

}  // namespace heel
