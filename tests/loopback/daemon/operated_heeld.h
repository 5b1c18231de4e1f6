// heeld under the command of an operator's client.
#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "loopback/daemon/heeld_fixture.h"
#include "support/socket_client.h"

namespace heel::test {

class OperatedHeeldFixture : public HeeldFixture {
 protected:
  std::string socket() const { return scene_.path("control.sock"); }
  std::string operated_config(const std::string& sections = "") const {
    return scene_.write_config({.sections = sections, .start = "operator"});
  }
  void get_ready(const std::string& config) {
    start_robot();
    start_heeld(config);
    ASSERT_TRUE(notify_.receives("READY=1")) << logs();
  }
  nlohmann::json ask(SocketClient& client, const std::string& request) {
    const std::string answer = client.ask(request);
    EXPECT_NE(answer, "") << request << logs();
    return nlohmann::json::parse(answer, nullptr, false);
  }
  nlohmann::json command(SocketClient& client, const std::string& name) {
    return ask(client, "{\"do\":\"" + name + "\"}");
  }
  /// A start is repeated: it may be refused while the first frames come, and on a busy machine late ticks are
  /// a fault, after which another start is needed.
  bool drives_after_start(SocketClient& client) {
    return eventually([&] {
      if (speed() > 0.2) return true;
      const std::string state = command(client, "status")["state"];
      if (state == "idle" || state == "stopped") command(client, "start");
      return false;
    });
  }
};

}  // namespace heel::test
