// What the section [mqtt] of the configuration says about the broker.
#pragma once

#include <string>

#include "core/config.h"
#include "operator/mqtt/broker_line.h"

namespace heel {

/// mqtt.topic with this computer's name in place of {host}.
std::string mqtt_topic(const MqttConfig& config);

/// Reads the password. Throws heel::Error naming the key and the file when it, or mqtt.ca_file, cannot be
/// used.
BrokerLogin broker_login(const MqttConfig& config);

/// A sentence for the log and for `heeld --check`: where the status goes, and who can read it on its way.
/// Empty without a broker. Throws as broker_login().
std::string mqtt_exposure(const MqttConfig& config);

}  // namespace heel
