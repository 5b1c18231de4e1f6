// The operator thread on a real socket, with a control loop that the test plays: what clients may do, and
// what they cannot do to each other.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "operator/operator_server.h"
#include "operator/played_loop.h"
#include "realtime/clock.h"
#include "support/complaint.h"
#include "support/process.h"
#include "support/socket_client.h"
#include "support/temporary_folder.h"

namespace heel {
namespace {

using nlohmann::json;
using test::PlayedLoop;
using test::SocketClient;
using ::testing::HasSubstr;

class Server : public ::testing::Test {
 protected:
  Server()
      : settings_(parse_config("[gate]\nv_max_m_s = 0.5\n", folder_.file("heel.toml")),
                  {[](const Config&) {},
                   [this](const Config&) {
                     while (held_.load()) sleep_until_ns(monotonic_now_ns() + kNsPerMs);
                   }}),
        settings_loop_(settings_),
        server_(LocalSocket(path_), loop_, settings_, settings_loop_),
        thread_([this] { server_.run(); }),
        settings_thread_([this] { settings_loop_.run(); }) {
    test::write_text(folder_.file("heel.toml"), "[gate]\nv_max_m_s = 0.5\n");
  }
  ~Server() override {
    held_ = false;
    settings_loop_.stop();
    server_.stop();
    settings_thread_.join();
    thread_.join();
  }

  const test::TemporaryFolder folder_;
  const std::string path_ = folder_.file("control.sock");
  PlayedLoop loop_;
  std::atomic<bool> held_{false};  ///< the settings thread waits in `apply`
  Settings settings_;
  SettingsLoop settings_loop_;
  OperatorServer server_;
  std::thread thread_, settings_thread_;
};

json ask(SocketClient& client, const std::string& request) {
  const std::string answer = client.ask(request);
  EXPECT_NE(answer, "") << "no answer to " << request;
  return json::parse(answer, nullptr, false);
}
json next(SocketClient& client) {
  return json::parse(client.line(), nullptr, false);
}

TEST_F(Server, TheSocketIsForTheUserAndTheGroup) {
  struct stat status {};
  ASSERT_EQ(stat(path_.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777u, 0660u);
}

TEST_F(Server, AnswersWithWhatBecameTrue) {
  SocketClient client(path_);
  json answer = ask(client, R"({"v":1,"id":7,"do":"start"})");
  EXPECT_EQ(answer["v"], 1);
  EXPECT_EQ(answer["id"], 7);
  EXPECT_EQ(answer["ok"], true);
  EXPECT_EQ(answer["state"], "armed");
  EXPECT_EQ(answer["outcome"], "done");
  EXPECT_NE(answer["sentence"], "");
  EXPECT_EQ(ask(client, R"({"do":"estop"})")["state"], "emergency");
  answer = ask(client, R"({"id":8,"do":"start"})");
  EXPECT_EQ(answer["ok"], false);
  EXPECT_EQ(answer["error"], "refused: emergency stop");
  EXPECT_EQ(answer["state"], "emergency");
  EXPECT_EQ(ask(client, R"({"do":"reset"})")["state"], "idle");
  EXPECT_EQ(ask(client, R"({"do":"stop"})")["state"], "idle");
}

TEST_F(Server, TheStatusHoldsRobotCameraTargetAndLimits) {
  SocketClient client(path_);
  ask(client, R"({"do":"set","values":{"gate.v_max_m_s":0.25}})");
  const json status = ask(client, R"({"id":1,"do":"status"})");
  for (const char* field :
       {"state", "sentence", "reason", "robot", "camera", "target", "command", "limits", "set"})
    EXPECT_TRUE(status.contains(field)) << field;
  EXPECT_EQ(status["camera"]["frames"], 42);
  EXPECT_EQ(status["limits"]["gate.v_max_m_s"], 0.25);
  ASSERT_EQ(status["set"].size(), 1u);
  EXPECT_EQ(status["set"][0]["before"], "0.5");
  EXPECT_EQ(status["set"][0]["after"], "0.25");
}

TEST_F(Server, SetAndSaveAnswerWithTheDifference) {
  SocketClient client(path_);
  json answer = ask(client, R"({"do":"set","values":{"gate.v_max_m_s":0.25,"control.reverse":false}})");
  EXPECT_EQ(answer["changes"], json::parse(R"([{"key":"gate.v_max_m_s","before":"0.5","after":"0.25"}])"));
  answer = ask(client, R"({"do":"set","values":{"gate.v_max_m_s":0.6,"gate.speed":1}})");
  EXPECT_EQ(answer["ok"], false);
  EXPECT_THAT(answer["error"].get<std::string>(), HasSubstr("gate.speed: no such key"));
  answer = ask(client, R"({"do":"save"})");
  EXPECT_EQ(answer["changes"].size(), 1u);
  EXPECT_EQ(test::read_text(folder_.file("heel.toml")), "[gate]\nv_max_m_s = 0.25\n");
  EXPECT_EQ(ask(client, R"({"do":"save"})")["changes"].size(), 0u);
}

TEST_F(Server, WhatWasAskedAndWhatBecameOfItGoesToTheRecording) {
  SocketClient client(path_);
  ask(client, R"({"do":"start"})");
  ask(client, R"({"do":"set","values":{"gate.v_max_m_s":0.25}})");
  ask(client, R"({"do":"set","values":{"gate.speed":1}})");
  ask(client, R"({"do":"save"})");
  EXPECT_EQ(ask(client, R"({"do":"mark","text":"it hesitates"})")["ok"], true);
  EXPECT_EQ(ask(client, R"({"do":"mark","text":"refuse"})")["error"], "nothing is recorded");
  EXPECT_THAT(loop_.marks(), testing::ElementsAre("it hesitates", "refuse"));
  EXPECT_THAT(loop_.answers(), testing::ElementsAre("start: done", "set: gate.v_max_m_s: 0.5 -> 0.25",
                                                    HasSubstr("set: gate.speed: no such key"),
                                                    "save: gate.v_max_m_s: 0.5 -> 0.25", "mark: done",
                                                    "mark: nothing is recorded"));
}

TEST_F(Server, HelpAndAlive) {
  SocketClient client(path_);
  EXPECT_EQ(ask(client, R"({"do":"help"})")["requests"].size(), request_table().size());
  EXPECT_EQ(ask(client, R"({"id":3,"do":"alive"})"), json::parse(R"({"v":1,"id":3,"ok":true})"));
}

TEST_F(Server, ALineThatIsWrongGetsAnErrorAndTheNextOneIsServed) {
  SocketClient client(path_);
  for (const std::string& wrong : {std::string("hello"), std::string("{}"), std::string("{\"do\":\"\xff\"}"),
                                   std::string("\0\x01", 2), std::string(100000, 'x')}) {
    const json answer = ask(client, wrong);
    EXPECT_EQ(answer["ok"], false);
    EXPECT_EQ(answer["error"].get<std::string>().find('\n'), std::string::npos);
  }
  EXPECT_EQ(ask(client, R"({"do":"stop"})")["ok"], true);
}

TEST_F(Server, EverySplitPointOfARequestGivesTheSameAnswer) {
  const std::string request = "{\"id\":5,\"do\":\"stop\"}\r\n";
  for (std::size_t cut = 1; cut < request.size(); ++cut) {
    SocketClient client(path_);
    client.send(request.substr(0, cut));
    std::this_thread::yield();
    client.send(request.substr(cut));
    const json answer = next(client);
    ASSERT_EQ(answer["id"], 5) << cut;
    ASSERT_EQ(answer["state"], "idle") << cut;
  }
}

TEST_F(Server, AClientThatClosesWithinALineHasAskedForNothing) {
  {
    SocketClient client(path_);
    client.send("{\"do\":\"start\"}");
  }
  {
    SocketClient client(path_);
    client.send("{\"do\":\"start\"}");
    client.end_output();
    EXPECT_THAT(client.line(), HasSubstr("the last line has no end"));
    EXPECT_TRUE(client.closed());
  }
  SocketClient client(path_);
  EXPECT_EQ(ask(client, R"({"do":"status"})")["state"], "idle");
  EXPECT_THAT(loop_.requests(), testing::IsEmpty());
}

TEST_F(Server, ARequestIsAnsweredAfterTheEndOfTheInput) {
  SocketClient client(path_);
  client.send("{\"id\":1,\"do\":\"start\"}\n{\"id\":2,\"do\":\"stop\"}\n");
  client.end_output();
  EXPECT_EQ(next(client)["id"], 1);
  EXPECT_EQ(next(client)["id"], 2);
  EXPECT_TRUE(client.closed());
}

TEST_F(Server, AnEmergencyStopIsServedBeforeTheRequestsThatCameWithIt) {
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

TEST_F(Server, TwoEmergencyStopsAreServedWhileASettingsJobHangs) {
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

TEST_F(Server, SettingsJobsThatWaitAreBounded) {
  held_ = true;
  SocketClient client(path_);
  const int many = static_cast<int>(SettingsLoop::kMaxWaiting) + 3;
  for (int i = 0; i < many; ++i)
    client.send("{\"id\":" + std::to_string(i) + ",\"do\":\"set\",\"values\":{\"gate.v_max_m_s\":0." +
                std::to_string(i + 10) + "}}\n");
  EXPECT_THAT(client.line(), HasSubstr("changes of settings wait already"));
  held_ = false;
}

TEST_F(Server, FiftyClientsThatHangDoNotKeepOutAnEmergencyStop) {
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

TEST_F(Server, AWatcherIsToldOfAChangeAtOnceAndOtherwiseOncePerPeriod) {
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

TEST_F(Server, WatchersAreBounded) {
  std::vector<std::unique_ptr<SocketClient>> watchers;
  for (std::size_t i = 0; i < OperatorServer::kMaxWatchers; ++i) {
    watchers.push_back(std::make_unique<SocketClient>(path_));
    EXPECT_EQ(ask(*watchers.back(), R"({"do":"watch"})")["event"], "status");
  }
  SocketClient client(path_);
  EXPECT_EQ(ask(client, R"({"do":"watch"})")["error"], "8 clients watch already");
}

TEST_F(Server, AClientThatDoesNotReadIsDroppedAndTheOthersAreServed) {
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

TEST_F(Server, AClientThatFloodsIsClosedAndItsEmergencyStopIsServed) {
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

TEST_F(Server, AClientThatWatchesAndFloodsIsClosed) {
  SocketClient client(path_);
  std::string flood = "{\"do\":\"watch\",\"period_s\":0.1}\n";
  for (int i = 0; i < 130; ++i) flood += "{\"do\":\"alive\"}\n";
  client.send(flood);
  EXPECT_TRUE(client.closed());
}

/// The end of an invited client.
class Invited {
 public:
  explicit Invited(int fd) : fd_(fd) {}
  ~Invited() { close(fd_); }
  Invited(const Invited&) = delete;
  Invited& operator=(const Invited&) = delete;

  json ask(const std::string& request) const {
    const std::string line = request + "\n";
    EXPECT_EQ(send(fd_, line.data(), line.size(), MSG_NOSIGNAL), static_cast<ssize_t>(line.size()));
    std::string answer;
    test::eventually([&] {
      std::array<char, 16384> bytes{};
      const ssize_t count = recv(fd_, bytes.data(), bytes.size(), MSG_DONTWAIT);
      if (count > 0) answer.append(bytes.data(), static_cast<std::size_t>(count));
      return answer.ends_with('\n');
    });
    return json::parse(answer, nullptr, false);
  }

 private:
  int fd_;
};

TEST_F(Server, AnInvitedClientReadsAndStopsUntilItMayWrite) {
  const auto may_write = std::make_shared<std::atomic<bool>>(false);
  const Invited invited(server_.invite("page, 192.168.1.7", may_write));
  EXPECT_EQ(invited.ask(R"({"do":"status"})")["ok"], true);
  EXPECT_EQ(invited.ask(R"({"do":"help"})")["ok"], true);
  for (const char* refused :
       {R"({"do":"start"})", R"({"do":"stop"})", R"({"do":"reset"})", R"({"do":"save"})", R"({"do":"mark"})",
        R"({"do":"alive"})", R"({"do":"set","values":{"gate.v_max_m_s":0.3}})"}) {
    const json answer = invited.ask(refused);
    EXPECT_EQ(answer["ok"], false) << answer;
    EXPECT_EQ(answer["needs_token"], true) << answer;
  }
  EXPECT_EQ(loop_.signs_of_life(), 0) << "it is no operator";
  EXPECT_TRUE(loop_.requests().empty());
  EXPECT_EQ(settings_.view().in_use.gate.v_max_m_s, 0.5);
  EXPECT_EQ(invited.ask(R"({"do":"estop"})")["state"], "emergency");
  *may_write = true;
  EXPECT_EQ(invited.ask(R"({"do":"reset"})")["outcome"], "done");
  EXPECT_EQ(loop_.signs_of_life(), 1);
  EXPECT_EQ(loop_.requests(), (std::vector{OperatorCommand::EStop, OperatorCommand::Reset}));
}

TEST_F(Server, InvitedClientsTakeNoPlaceOfLocalOnes) {
  const auto may_write = std::make_shared<std::atomic<bool>>(true);
  std::vector<std::unique_ptr<Invited>> invited;
  for (std::size_t i = 0; i < OperatorServer::kMaxWatchers; ++i) {
    invited.push_back(std::make_unique<Invited>(server_.invite("page", may_write)));
    EXPECT_EQ(invited.back()->ask(R"({"do":"watch","period_s":60})")["event"], "status");
  }
  std::vector<std::unique_ptr<SocketClient>> clients;
  for (std::size_t i = 0; i < OperatorServer::kMaxClients; ++i)
    clients.push_back(std::make_unique<SocketClient>(path_));
  EXPECT_EQ(ask(*clients.back(), R"({"do":"watch"})")["event"], "status");
  EXPECT_EQ(ask(*clients.front(), R"({"do":"alive"})")["ok"], true) << "none was closed";
}

TEST_F(Server, AControlLoopThatDoesNotAnswerIsNamed) {
  loop_.be_deaf();
  SocketClient client(path_);
  EXPECT_THAT(ask(client, R"({"do":"start"})")["error"].get<std::string>(),
              HasSubstr("the control loop did not answer"));
}

TEST(OperatorSocket, AStaleSocketIsReplacedAndALiveOneIsNot) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("control.sock");
  {
    const LocalSocket live(path);
    EXPECT_THAT(test::complaint_of([&] { LocalSocket second(path); }),
                HasSubstr("operator.socket: " + path + ": another process serves it"));
    EXPECT_TRUE(std::filesystem::exists(path)) << "the refused one must not remove it";
    std::filesystem::rename(path, folder.file("stale.sock"));
  }
  // The first socket could not remove its file under the new name: nobody serves it any more.
  ASSERT_TRUE(std::filesystem::exists(folder.file("stale.sock")));
  std::filesystem::rename(folder.file("stale.sock"), path);
  {
    const LocalSocket next(path);
    const SocketClient client(path);
  }
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(OperatorSocket, OneOfAnotherUserIsNamedWithThePermission) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("control.sock");
  std::filesystem::permissions(folder.path(), std::filesystem::perms{0755});
  const LocalSocket live(path);
  const uid_t owner = geteuid();
  std::filesystem::permissions(path, std::filesystem::perms{0000});
  // Permissions do not hold for root, who becomes another user for this call.
  ASSERT_EQ(owner == 0 ? seteuid(65534) : 0, 0);
  const uid_t user = geteuid();
  const std::string complaint = test::complaint_of([&] { LocalSocket second(path); });
  ASSERT_EQ(owner == 0 ? seteuid(0) : 0, 0);
  EXPECT_EQ(complaint, "operator.socket: " + path + ": permission denied: it belongs to user " +
                           std::to_string(owner) + " (expected a socket that user " + std::to_string(user) +
                           " may use, or a name that is free)");
}

TEST(OperatorSocket, WhatIsNoSocketIsNotRemoved) {
  const test::TemporaryFolder folder;
  const std::string path = test::write_text(folder.file("control.sock"), "mine");
  EXPECT_THAT(test::complaint_of([&] { LocalSocket socket(path); }), HasSubstr("exists and is no socket"));
  EXPECT_EQ(test::read_text(path), "mine");
  EXPECT_THAT(test::complaint_of([&] { LocalSocket socket(folder.file("no/control.sock")); }),
              HasSubstr("cannot be made: No such file or directory (expected a folder that exists"));
  EXPECT_THAT(test::complaint_of([&] { LocalSocket socket(folder.file(std::string(200, 'x'))); }),
              HasSubstr("(expected at most 107)"));
}

}  // namespace
}  // namespace heel
