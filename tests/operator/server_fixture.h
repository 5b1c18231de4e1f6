// The operator thread on a real socket, with a control loop that the test plays.
#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "operator/operator_server.h"
#include "operator/played_loop.h"
#include "realtime/clock.h"
#include "support/socket_client.h"
#include "support/temporary_folder.h"

namespace heel::test {

class ServerFixture : public ::testing::Test {
 protected:
  ServerFixture()
      : settings_(parse_config("[gate]\nv_max_m_s = 0.5\n", folder_.file("heel.toml")),
                  {[](const Config&) {},
                   [this](const Config&) {
                     while (held_.load()) sleep_until_ns(monotonic_now_ns() + kNsPerMs);
                   }}),
        settings_loop_(settings_),
        server_(LocalSocket(path_), loop_, settings_, settings_loop_),
        thread_([this] { server_.run(); }),
        settings_thread_([this] { settings_loop_.run(); }) {
    write_text(folder_.file("heel.toml"), "[gate]\nv_max_m_s = 0.5\n");
  }
  ~ServerFixture() override {
    held_ = false;
    settings_loop_.stop();
    server_.stop();
    settings_thread_.join();
    thread_.join();
  }

  const TemporaryFolder folder_;
  const std::string path_ = folder_.file("control.sock");
  PlayedLoop loop_;
  std::atomic<bool> held_{false};  ///< the settings thread waits in `apply`
  Settings settings_;
  SettingsLoop settings_loop_;
  OperatorServer server_;
  std::thread thread_, settings_thread_;
};

inline nlohmann::json ask(SocketClient& client, const std::string& request) {
  const std::string answer = client.ask(request);
  EXPECT_NE(answer, "") << "no answer to " << request;
  return nlohmann::json::parse(answer, nullptr, false);
}
inline nlohmann::json next(SocketClient& client) {
  return nlohmann::json::parse(client.line(), nullptr, false);
}

}  // namespace heel::test
