// What clients of the operator thread cannot do to each other, and to an emergency stop.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "operator/server_fixture.h"
#include "support/process.h"

namespace heel {
namespace {

using nlohmann::json;
using test::ask;
using test::next;
using test::SocketClient;
using ::testing::HasSubstr;

using BoundedServer = test::ServerFixture;

TEST_F(BoundedServer, AnEmergencyStopIsServedBeforeTheRequestsThatCameWithIt) {
  SocketClient client(path_);
  client.send("{\"id\":1,\"do\":\"start\"}\n{\"id\":2,\"do\":\"reset\"}\n{\"id\":3,\"do\":\"estop\"}\n");
  bool stopped = false;
  for (int i = 0; i < 3; ++i) {
    const json answer = next(client);
    if (answer["id"] == 3) stopped = answer["ok"] == true && answer["state"] == "emergency";
  }
  EXPECT_TRUE(stopped);
  EXPECT_EQ(loop_.requests().front(), OperatorCommand::EStop);
}

TEST_F(BoundedServer, TwoEmergencyStopsAreServedWhileASettingsJobHangs) {
  held_ = true;
  SocketClient setter(path_);
  setter.send("{\"id\":1,\"do\":\"set\",\"values\":{\"gate.v_max_m_s\":0.1}}\n{\"id\":2,\"do\":\"save\"}\n");
  SocketClient one(path_), two(path_);
  EXPECT_EQ(ask(one, R"({"do":"estop"})")["state"], "emergency");
  EXPECT_EQ(ask(two, R"({"do":"estop"})")["state"], "emergency");
  EXPECT_EQ(setter.line(0.05), "") << "the job hangs";
  setter.send("{\"id\":3,\"do\":\"estop\"}\n");
  EXPECT_EQ(next(setter)["id"], 3) << "the same client, too";
  held_ = false;
  EXPECT_EQ(next(setter)["id"], 1);
  EXPECT_EQ(next(setter)["id"], 2);
}

TEST_F(BoundedServer, SettingsJobsThatWaitAreBounded) {
  held_ = true;
  SocketClient client(path_);
  const int many = static_cast<int>(SettingsLoop::kMaxWaiting) + 3;
  for (int i = 0; i < many; ++i)
    client.send("{\"id\":" + std::to_string(i) + ",\"do\":\"set\",\"values\":{\"gate.v_max_m_s\":0." +
                std::to_string(i + 10) + "}}\n");
  EXPECT_THAT(client.line(), HasSubstr("changes of settings wait already"));
  held_ = false;
}

TEST_F(BoundedServer, FiftyClientsThatHangDoNotKeepOutAnEmergencyStop) {
  std::vector<std::unique_ptr<SocketClient>> hanging;
  for (int i = 0; i < 50; ++i) {
    hanging.push_back(std::make_unique<SocketClient>(path_));
    hanging.back()->send("{\"do\":");
  }
  SocketClient client(path_);
  EXPECT_EQ(ask(client, R"({"do":"estop"})")["state"], "emergency");
  int closed = 0;
  for (const auto& one : hanging) closed += one->closed(0.0) || one->closed(0.01);
  EXPECT_GE(closed, 50 - static_cast<int>(OperatorServer::kMaxClients));
}

TEST_F(BoundedServer, AWatcherIsToldOfAChangeAtOnceAndOtherwiseOncePerPeriod) {
  SocketClient watcher(path_), client(path_);
  watcher.send("{\"id\":4,\"do\":\"watch\",\"period_s\":60}\n");
  json line = next(watcher);
  EXPECT_EQ(line["id"], 4);
  EXPECT_EQ(line["event"], "status");
  EXPECT_EQ(line["state"], "idle");
  ask(client, R"({"do":"start"})");
  EXPECT_EQ(next(watcher)["state"], "armed");
  ask(client, R"({"do":"set","values":{"gate.v_max_m_s":0.25}})");
  EXPECT_EQ(next(watcher)["set"].size(), 1u);
  watcher.send("{\"id\":5,\"do\":\"watch\",\"period_s\":0.1}\n");
  while (line["id"] != 5) line = next(watcher);
  const std::uint64_t tick = line["tick"];
  EXPECT_GT(next(watcher)["tick"], tick) << "nothing has changed";
}

TEST_F(BoundedServer, WatchersAreBounded) {
  std::vector<std::unique_ptr<SocketClient>> watchers;
  for (std::size_t i = 0; i < OperatorServer::kMaxWatchers; ++i) {
    watchers.push_back(std::make_unique<SocketClient>(path_));
    EXPECT_EQ(ask(*watchers.back(), R"({"do":"watch"})")["event"], "status");
  }
  SocketClient client(path_);
  EXPECT_EQ(ask(client, R"({"do":"watch"})")["error"], "8 clients watch already");
}

TEST_F(BoundedServer, AClientThatDoesNotReadIsDroppedAndTheOthersAreServed) {
  SocketClient slow(path_), client(path_);
  // Help is the longest answer for a short request; a second's requests fill the socket and the bound.
  bool dropped = false;
  for (int i = 0; i < 2000 && !dropped; ++i) {
    dropped = !slow.send("{\"do\":\"status\"}\n");
    if (i % 50 == 0) {
      ASSERT_EQ(ask(client, R"({"do":"alive"})")["ok"], true);
      test::sleep_s(0.6);  // less than the bound on requests a second
    }
  }
  EXPECT_TRUE(dropped);
}

TEST_F(BoundedServer, AClientThatFloodsIsClosedAndItsEmergencyStopIsServed) {
  SocketClient client(path_);
  std::string flood;
  for (int i = 0; i < 130; ++i) flood += "{\"do\":\"alive\"}\n";
  client.send(flood + "{\"id\":99,\"do\":\"estop\"}\n");
  bool closed_for_it = false, stopped = false;
  for (std::string line = client.line(); !line.empty(); line = client.line()) {
    closed_for_it |= line.find("too many requests (expected at most 100 a second)") != std::string::npos;
    const json answer = json::parse(line);
    stopped |= answer.value("id", 0) == 99 && answer["state"] == "emergency";
  }
  EXPECT_TRUE(closed_for_it);
  EXPECT_TRUE(stopped);
  EXPECT_TRUE(client.closed());
}

TEST_F(BoundedServer, AClientThatWatchesAndFloodsIsClosed) {
  SocketClient client(path_);
  std::string flood = "{\"do\":\"watch\",\"period_s\":0.1}\n";
  for (int i = 0; i < 130; ++i) flood += "{\"do\":\"alive\"}\n";
  client.send(flood);
  EXPECT_TRUE(client.closed());
}

TEST_F(BoundedServer, AControlLoopThatDoesNotAnswerIsNamed) {
  loop_.be_deaf();
  SocketClient client(path_);
  EXPECT_THAT(ask(client, R"({"do":"start"})")["error"].get<std::string>(),
              HasSubstr("the control loop did not answer"));
}

}  // namespace
}  // namespace heel
