// What clients of the operator thread ask for, and what it answers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
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

using Server = test::ServerFixture;

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
  EXPECT_EQ(status["camera"]["picture"], nullptr) << "no frame yet";
  EXPECT_EQ(status["limits"]["gate.v_max_m_s"], 0.25);
  ASSERT_EQ(status["set"].size(), 1u);
  EXPECT_EQ(status["set"][0]["before"], "0.5");
  EXPECT_EQ(status["set"][0]["after"], "0.25");
}

TEST_F(Server, AWatcherIsToldWhatThePicturesShowWrong) {
  SocketClient watcher(path_);
  EXPECT_EQ(ask(watcher, R"({"do":"watch","period_s":60})")["camera"]["picture"], nullptr);
  PoseEstimate pose;
  pose.picture = PictureFault::OutOfFocus;
  loop_.see(pose);
  EXPECT_EQ(next(watcher)["camera"]["picture"], "out of focus");
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

}  // namespace
}  // namespace heel
