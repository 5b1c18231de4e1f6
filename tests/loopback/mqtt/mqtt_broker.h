// Mosquitto, Debian's MQTT broker, for one test: on a port of its own, with nothing of the machine's
// configuration; and its clients, which read and write what robots and people do.
#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/process.h"
#include "support/temporary_folder.h"

namespace heel::test {

/// A port of 127.0.0.1 at which nobody listens.
std::uint16_t free_port();

class MqttBroker {
 public:
  struct Access {
    std::string user, password;  ///< empty: everybody may
    bool tls = false;            ///< by a certificate for 127.0.0.1, whose authority is ca_file()
  };
  explicit MqttBroker(const Access& access);
  MqttBroker() : MqttBroker(Access{}) {}

  void start();
  void kill();
  /// SIGSTOP: it hangs; SIGCONT: it goes on.
  void signal(int number) const { process_->signal(number); }
  std::string address() const;
  std::string ca_file() const { return folder_.file("ca.pem"); }
  /// What it has logged, every packet of every client.
  std::string log() const { return read_text(folder_.file("log")); }
  /// A client's program with the options that connect it.
  std::vector<std::string> client(const std::string& program, const std::vector<std::string>& more) const;

 private:
  const TemporaryFolder folder_;
  const Access access_;
  const std::uint16_t port_ = free_port();
  std::unique_ptr<Process> process_;
};

/// Reads all topics from its start on, the retained messages first.
class MqttReader {
 public:
  explicit MqttReader(const MqttBroker& broker);

  /// The messages of the topic so far.
  std::vector<std::string> of(const std::string& topic) const;
  /// The newest one; empty when there is none.
  std::string newest(const std::string& topic) const;
  /// The newest one as JSON; null when there is none.
  nlohmann::json newest_json(const std::string& topic) const;
  bool hears(const std::string& topic, const std::string& text) const;

 private:
  Process process_;
};

}  // namespace heel::test
