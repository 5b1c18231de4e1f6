// heeld under command over its real socket, with the simulated robot over a pty: it moves after a start only,
// stops when it is told to, an emergency stop acts in the next tick, and clients that misbehave disturb
// nobody.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "files/csv_table.h"
#include "loopback/daemon/emergency_stop.h"
#include "loopback/daemon/operated_heeld.h"
#include "support/exported.h"
#include "support/socket_client.h"

namespace heel {
namespace {

using nlohmann::json;
using test::emergency_stop_after;
using test::EmergencyStop;
using test::eventually;
using test::monotonic_s;
using test::read_text;
using test::sleep_s;
using test::SocketClient;
using test::write_text;

using ::testing::HasSubstr;

using OperatedHeeld = test::OperatedHeeldFixture;

TEST_F(OperatedHeeld, MovesAfterAStartOnlyAndRestsAfterAStop) {
  get_ready(operated_config());
  SocketClient client(socket());
  EXPECT_EQ(command(client, "status")["state"], "idle");
  sleep_s(1.0);
  EXPECT_EQ(speed(), 0.0) << "nobody has started it";

  ASSERT_TRUE(drives_after_start(client)) << logs();
  EXPECT_TRUE(eventually([&] { return command(client, "start")["outcome"] == "already so"; })) << logs();

  EXPECT_EQ(command(client, "stop")["state"], "idle");
  EXPECT_TRUE(comes_to_rest()) << logs();
  sleep_s(1.0);
  EXPECT_EQ(speed(), 0.0) << "it needs a start";
  EXPECT_TRUE(drives_after_start(client)) << logs();
}

TEST_F(OperatedHeeld, AnEmergencyStopHoldsUntilAResetAndAStart) {
  get_ready(operated_config());
  SocketClient client(socket());
  ASSERT_TRUE(drives_after_start(client)) << logs();
  const json stopped = command(client, "estop");
  EXPECT_EQ(stopped["ok"], true);
  EXPECT_EQ(stopped["state"], "emergency");
  EXPECT_TRUE(comes_to_rest()) << logs();
  const json refused = command(client, "start");
  EXPECT_EQ(refused["ok"], false);
  EXPECT_EQ(refused["state"], "emergency");
  EXPECT_EQ(command(client, "stop")["state"], "emergency");
  EXPECT_EQ(command(client, "reset")["state"], "idle");
  sleep_s(0.5);
  EXPECT_EQ(speed(), 0.0) << "a reset is no start";
  EXPECT_TRUE(drives_after_start(client)) << logs();
}

TEST_F(OperatedHeeld, AnEmergencyStopActsInTheNextTickByTheRecording) {
  get_ready(operated_config("[telemetry]\ndirectory = \"run\"\n"));
  SocketClient client(socket());
  std::vector<double> asked_s;
  for (int attempt = 0; attempt < 3; ++attempt) {
    ASSERT_TRUE(drives_after_start(client)) << logs();
    asked_s.push_back(monotonic_s());
    ASSERT_EQ(command(client, "estop")["state"], "emergency");
    ASSERT_TRUE(comes_to_rest());
    ASSERT_EQ(command(client, "reset")["state"], "idle");
  }
  daemon_->signal(SIGTERM);
  ASSERT_EQ(daemon_->wait(), 0) << logs();
  const CsvTable ticks(test::exported(scene_.path("run")) + "/ticks.csv");
  int at_once = 0;
  for (const double t_asked_s : asked_s) {
    const EmergencyStop stop = emergency_stop_after(ticks, t_asked_s);
    ASSERT_TRUE(stop.found);
    EXPECT_EQ(stop.state, "emergency") << "in the tick that has the request";
    EXPECT_EQ(stop.v_m_s, 0.0);
    EXPECT_EQ(stop.yaw_rate_rad_s, 0.0);
    at_once += stop.ticks_before == 0;
    // A tick that began between the request's time and its arrival cannot have it.
    EXPECT_LE(stop.ticks_before, 1) << stop.latency_s;
  }
  EXPECT_GE(at_once, 1) << "in one of three the next tick has it";
}

TEST_F(OperatedHeeld, TwoEmergencyStopsDuringASaveAreServedAndTheFileIsWhole) {
  const std::string config = operated_config("[gate]\n# mine\nv_max_m_s = 0.5 # slow\n");
  get_ready(config);
  SocketClient setter(socket()), one(socket()), two(socket());
  ASSERT_TRUE(drives_after_start(one)) << logs();
  ASSERT_EQ(
      ask(setter, R"({"do":"set","values":{"gate.v_max_m_s":0.3,"control.deadband_distance_m":0.06}})")["ok"],
      true);
  setter.send("{\"id\":1,\"do\":\"save\"}\n");
  one.send("{\"do\":\"estop\"}\n");
  two.send("{\"do\":\"estop\"}\n");
  EXPECT_EQ(json::parse(one.line())["state"], "emergency");
  EXPECT_EQ(json::parse(two.line())["state"], "emergency");
  const json saved = json::parse(setter.line());
  EXPECT_EQ(saved["id"], 1);
  EXPECT_EQ(saved["changes"].size(), 2u);
  EXPECT_TRUE(comes_to_rest());
  const std::string text = read_text(config);
  EXPECT_THAT(text, HasSubstr("[gate]\n# mine\nv_max_m_s = 0.3 # slow\n"));
  EXPECT_THAT(text, HasSubstr("[control]\ndeadband_distance_m = 0.06\n"));
}

TEST_F(OperatedHeeld, ClientsThatMisbehaveDoNotStopItNorKeepOutAnEmergencyStop) {
  get_ready(operated_config());
  SocketClient client(socket());
  ASSERT_TRUE(drives_after_start(client)) << logs();

  std::vector<std::unique_ptr<SocketClient>> others;
  const auto other = [&]() -> SocketClient& {
    others.push_back(std::make_unique<SocketClient>(socket()));
    return *others.back();
  };
  for (const std::string& bytes :
       {std::string("hello\n"), std::string(100000, '{'), std::string("\0\xff\n", 3),
        std::string("{\"do\":\"set\",\"values\":{\"gate.v_max_m_s\":\"fast\"}}\n"),
        std::string("{\"do\":\"start\"")})
    other().send(bytes);
  for (int i = 0; i < 50; ++i) other().send("{\"do\":");
  SocketClient& slow = other();  // asks and does not read
  for (int i = 0; i < 90; ++i) slow.send("{\"do\":\"status\"}\n");
  other().send("{\"do\":\"watch\",\"period_s\":0.1}\n");
  sleep_s(1.0);
  SocketClient newcomer(socket());
  const std::string state = command(newcomer, "status")["state"];
  EXPECT_THAT(state, testing::AnyOf("following", "waiting", "stopped")) << "none of them has commanded it";
  EXPECT_TRUE(drives_after_start(newcomer)) << logs();
  EXPECT_EQ(command(newcomer, "estop")["state"], "emergency") << logs();
  EXPECT_TRUE(comes_to_rest());
  EXPECT_TRUE(daemon_->running());
}

TEST_F(OperatedHeeld, AtAReloadTheFileWins) {
  const std::string config = operated_config("[gate]\nv_max_m_s = 0.5\n");
  get_ready(config);
  SocketClient client(socket());
  ask(client, R"({"do":"set","values":{"gate.v_max_m_s":0.1}})");
  EXPECT_EQ(command(client, "status")["limits"]["gate.v_max_m_s"], 0.1);
  daemon_->signal(SIGHUP);
  EXPECT_TRUE(daemon_->says("the reload drops what was set and not saved: gate.v_max_m_s: 0.1 -> 0.5"))
      << logs();
  EXPECT_TRUE(eventually([&] { return command(client, "status")["limits"]["gate.v_max_m_s"] == 0.5; }));
}

TEST_F(OperatedHeeld, AValueThatIsSetIsInForceWhileDriving) {
  get_ready(operated_config());
  SocketClient client(socket());
  ASSERT_TRUE(drives_after_start(client)) << logs();
  ASSERT_EQ(ask(client, R"({"do":"set","values":{"gate.v_max_m_s":0.1}})")["ok"], true);
  EXPECT_TRUE(eventually([&] {
    if (command(client, "status")["state"] == "stopped") command(client, "start");
    return speed() > 0.05 && speed() < 0.12;
  })) << speed();
}

TEST_F(OperatedHeeld, TheSocketOfADeadHeeldIsReplacedAndThatOfALiveOneIsNot) {
  const std::string config = operated_config();
  start_heeld(config);
  ASSERT_TRUE(daemon_->says("operators are served at")) << logs();
  test::Process second({test::built_program("heeld"), "--config", config});
  EXPECT_EQ(second.wait(), 78);
  EXPECT_THAT(second.output(), HasSubstr("operator.socket: " + socket() + ": another process serves it"));
  {
    SocketClient client(socket());
    EXPECT_EQ(command(client, "alive")["ok"], true) << "the first one goes on";
  }
  daemon_->signal(SIGKILL);
  ASSERT_EQ(daemon_->wait(), -SIGKILL);
  ASSERT_TRUE(std::filesystem::exists(socket()));
  start_heeld(config);
  ASSERT_TRUE(daemon_->says("operators are served at")) << logs();
  SocketClient client(socket());
  EXPECT_EQ(command(client, "alive")["ok"], true);

  daemon_->signal(SIGTERM);
  EXPECT_EQ(daemon_->wait(), 0);
  EXPECT_TRUE(client.closed());
  EXPECT_FALSE(std::filesystem::exists(socket()));
}

TEST_F(OperatedHeeld, ASecondHeeldDoesNotTouchTheRobotOfTheFirst) {
  const std::string config = operated_config();
  get_ready(config);
  test::Process second({test::built_program("heeld"), "--config", config});
  EXPECT_EQ(second.wait(), 78);
  EXPECT_THAT(second.output(), HasSubstr("another process serves it"));
  EXPECT_FALSE(robot_->says("closed", 1.0)) << "the session of the first" << logs();
  SocketClient client(socket());
  EXPECT_EQ(command(client, "status")["robot"]["reconnects"], 0) << logs();
}

TEST_F(OperatedHeeld, WithoutASocketItRunsAndReloads) {
  const std::string config = scene_.write_config({.start = "operator"});
  std::string text = read_text(config);
  text.replace(text.find("control.sock"), std::string("control.sock").size(), "");
  write_text(config, text);
  start_heeld(config);
  ASSERT_TRUE(notify_.receives("STATUS=")) << logs();
  EXPECT_FALSE(std::filesystem::exists(socket()));
  daemon_->signal(SIGHUP);
  EXPECT_TRUE(daemon_->says("reloaded")) << logs();
}

}  // namespace
}  // namespace heel
