// A connection to an MQTT broker that publishes, and subscribes to nothing. The module mqtt.so makes one, by
// Eclipse Paho (src/operator/mqtt/paho). One thread uses it; no call waits longer than kBrokerPatience_ns,
// but for the look-up of the broker's name.
#pragma once

#include <string>

#include "heel/time.h"

namespace heel {

/// For a connection. Stopping heeld must take less than TimeoutStopSec of its service.
inline constexpr TimeNs kBrokerPatience_ns = 3 * kNsPerS;

struct BrokerLogin {
  std::string address;  ///< tcp://HOST:PORT or ssl://HOST:PORT
  std::string client;   ///< a broker has one client of a name
  std::string user;     ///< empty: none
  std::string password;
  std::string ca_file;  ///< empty: the authorities that the system trusts
  // What the broker publishes, retained, when the connection ends without disconnect().
  std::string will_topic;
  std::string will;
};

class BrokerLine {
 public:
  virtual ~BrokerLine() = default;
  /// Tries once. Returns why there is no connection; empty: there is one.
  virtual std::string connect() = 0;
  /// Hands over a retained message of QoS 1. False: the connection is lost.
  virtual bool publish(const std::string& topic, const std::string& text) = 0;
  /// The broker has confirmed all that was published.
  virtual bool confirmed() = 0;
  /// Waits for the broker and answers it, for that long. False: the connection is lost.
  virtual bool serve(TimeNs wait_ns) = 0;
  /// In order, without the will.
  virtual void disconnect() = 0;
};

/// What the module exports under the name kBrokerLineEntry. The caller owns the line.
using BrokerLineEntry = BrokerLine*(const BrokerLogin& login);
inline constexpr const char* kBrokerLineEntry = "heel_make_broker_line";

}  // namespace heel
