// The operator thread when it runs late: requests that wait in the sockets meanwhile.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <thread>

#include "operator/operator_server.h"
#include "operator/played_loop.h"
#include "support/collected_log.h"
#include "support/sanitized.h"
#include "support/socket_client.h"
#include "support/temporary_folder.h"

namespace heel {
namespace {

using test::SocketClient;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class BusyServer : public ::testing::Test {
 protected:
  BusyServer()
      : settings_(parse_config("", folder_.file("heel.toml")), {[](const Config&) {}, [](const Config&) {}}),
        settings_loop_(settings_),
        server_(LocalSocket(path_), loop_, settings_, settings_loop_) {}
  ~BusyServer() override {
    loop_.release();
    server_.stop();
    if (thread_.joinable()) thread_.join();
  }
  void run() {
    thread_ = std::thread([this] { server_.run(); });
  }

  const test::TemporaryFolder folder_;
  const std::string path_ = folder_.file("control.sock");
  test::PlayedLoop loop_;
  Settings settings_;
  SettingsLoop settings_loop_;
  OperatorServer server_;
  std::thread thread_;
};

TEST_F(BusyServer, AStartIsNotDoneAfterItsClientHasGone) {
  {
    SocketClient client(path_);
    ASSERT_TRUE(client.send("{\"do\":\"start\"}\n"));
  }
  run();
  SocketClient client(path_);
  EXPECT_THAT(client.ask(R"({"do":"status"})"), HasSubstr(R"("state":"idle")"));
  EXPECT_THAT(client.ask(R"({"do":"alive"})"), HasSubstr("true"));
  EXPECT_THAT(loop_.requests(), IsEmpty());
  EXPECT_THAT(client.ask(R"({"do":"start"})"), HasSubstr("armed")) << "its client waits for the answer";
}

TEST_F(BusyServer, AStopIsDoneAlsoAfterItsClientHasGone) {
  for (const char* command : {"stop", "estop"}) {
    SocketClient client(path_);
    ASSERT_TRUE(client.send(std::string("{\"do\":\"") + command + "\"}\n"));
  }
  run();
  EXPECT_TRUE(test::eventually([&] { return loop_.requests().size() == 2; }));
  EXPECT_THAT(loop_.requests(), ElementsAre(OperatorCommand::EStop, OperatorCommand::Stop));
}

TEST_F(BusyServer, AnEmergencyStopIsNotLostWhenAnotherClientTakesThePlaceOfItsClient) {
  run();
  std::vector<std::unique_ptr<SocketClient>> clients;
  for (std::size_t i = 0; i < OperatorServer::kMaxClients; ++i) {
    clients.push_back(std::make_unique<SocketClient>(path_));
    ASSERT_NE(clients.back()->ask(R"({"do":"alive"})"), "");
  }
  SocketClient& idlest = *clients.front();
  // Both come while the thread serves another client.
  loop_.hold();
  clients.back()->send("{\"do\":\"alive\"}\n");
  ASSERT_TRUE(test::eventually([&] { return loop_.holds(); }));
  idlest.send(std::string(30000, 'x') + "\n{\"id\":1,\"do\":\"estop\"}\n");
  SocketClient another(path_);
  loop_.release();
  EXPECT_THAT(another.ask(R"({"do":"alive"})"), HasSubstr("true"));
  EXPECT_THAT(loop_.requests(), ElementsAre(OperatorCommand::EStop));
  EXPECT_THAT(idlest.line(), HasSubstr("a line of more than 4096 bytes"));
  EXPECT_THAT(idlest.line(), HasSubstr(R"("state":"emergency")"));
}

/// No descriptor can be opened in this process while it lives.
class NoFreeDescriptor {
 public:
  NoFreeDescriptor() {
    const int lowest = dup(0);
    close(lowest);
    getrlimit(RLIMIT_NOFILE, &before_);
    const rlimit none{static_cast<rlim_t>(lowest), before_.rlim_max};
    setrlimit(RLIMIT_NOFILE, &none);
  }
  ~NoFreeDescriptor() { setrlimit(RLIMIT_NOFILE, &before_); }

 private:
  rlimit before_{};
};

TEST_F(BusyServer, WithoutAFreeDescriptorItTriesAgainWithPauses) {
  if (test::kSanitized) GTEST_SKIP() << "the sanitizer itself needs a descriptor for its checks";
  const test::CollectedLog log;
  run();
  SocketClient first(path_);
  loop_.hold();
  first.send("{\"do\":\"alive\"}\n");
  ASSERT_TRUE(test::eventually([&] { return loop_.holds(); }));
  SocketClient second(path_);
  second.send("{\"do\":\"alive\"}\n");
  std::uint64_t rounds = 0;
  {
    const NoFreeDescriptor none;
    rounds = loop_.ticks_taken();
    loop_.release();
    EXPECT_EQ(second.line(0.5), "");
    rounds = loop_.ticks_taken() - rounds;
  }
  EXPECT_GE(rounds, 2u);
  EXPECT_LE(rounds, 30u) << "the thread must not spin";
  EXPECT_NE(second.line(), "") << "it is accepted when there is a descriptor";
  server_.stop();
  thread_.join();
  EXPECT_EQ(log.count("no client can be accepted: Too many open files; heeld tries again"), 1) << log.text();
}

}  // namespace
}  // namespace heel
