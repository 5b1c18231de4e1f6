// What clients that mean harm, or are broken, can do to the page's server: nothing that others notice.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <random>
#include <string>
#include <vector>

#include "operator/web/limits.h"
#include "operator/web/page_fixture.h"

namespace heel {
namespace {

using nlohmann::json;
using test::kToken;
using test::monotonic_s;
using test::PageClient;

using AttackedPage = test::PageFixture;

TEST_F(AttackedPage, PagesOfOtherSitesAreRefused) {
  const std::string ours = "127.0.0.1:" + std::to_string(port());
  EXPECT_EQ(client()->ask("GET /api/info", "Host: evil.example\r\n").status, 421) << "DNS rebinding";
  EXPECT_EQ(client()->ask("GET /", "Host: 127.0.0.1.evil.example\r\n").status, 421);
  EXPECT_EQ(client()->ask("GET /", "Host: \r\n").status, 421);
  EXPECT_EQ(client()->ask("GET /", "Host: robot.local:8080\r\n").status, 200) << "in view.hosts";
  EXPECT_EQ(client()->ask("GET /", "Host: [fe80::1]:8080\r\n").status, 200);
  EXPECT_EQ(client()->ask("GET /", "Host: " + ours + "\r\nHost: evil.example\r\n").status, 400);
  const std::vector<std::string> foreign = {"http://evil.example", "null", "https://127.0.0.1",
                                            "http://" + ours + ".evil.example", "file://"};
  for (const std::string& origin : foreign) {
    const std::string header = "Origin: " + origin + "\r\n";
    EXPECT_EQ(client()->ask("POST /estop", header).status, 403) << origin;
    EXPECT_EQ(client()->ask("GET /api/config", header).status, 403) << origin;
    EXPECT_FALSE(client()->become_websocket("/operator", header)) << origin;
    EXPECT_FALSE(client()->become_websocket("/live", header)) << origin;
  }
  EXPECT_EQ(client()->ask("GET /api/config", "Sec-Fetch-Site: cross-site\r\n").status, 403);
  EXPECT_EQ(client()->ask("GET /", "Sec-Fetch-Site: cross-site\r\n").status, 200) << "a link to the page";
  EXPECT_TRUE(loop_.requests().empty());
  EXPECT_EQ(client()->ask("POST /estop", "Origin: http://" + ours + "\r\n").status, 200);
  EXPECT_TRUE(client()->become_websocket("/operator", "Origin: http://" + ours + "\r\n"));
}

TEST_F(AttackedPage, DamagedRequestsAreAnsweredOrClosed) {
  for (const std::string bytes :
       {"\r\n\r\n", "GET\r\n\r\n", "GET / HTTP/9.9\r\n\r\n", "GET / HTTP/1.1\r\nHost 127.0.0.1\r\n\r\n",
        "POST /estop HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: -1\r\n\r\n",
        "POST /estop HTTP/1.1\r\nHost: 127.0.0.1\r\nTransfer-Encoding: chunked\r\n\r\nzz\r\n",
        "\x16\x03\x01\x02\x01\x01", "GET /\xff\xfe HTTP/1.1\r\nHost: 127.0.0.1\r\n\xff: 1\r\n\r\n"}) {
    const auto attacker = client();
    attacker->send(bytes + "\r\n\r\n");
    EXPECT_TRUE(attacker->closed()) << bytes;
  }
  EXPECT_EQ(client()->ask("GET /", "X: " + std::string(kMaxHeadBytes, 'a') + "\r\n").status, 431);
  EXPECT_EQ(client()->ask("GET /" + std::string(2 * kMaxHeadBytes, 'a')).status, 431);
  EXPECT_EQ(
      client()->ask("POST /estop", "Content-Length: " + std::to_string(kMaxBodyBytes + 1) + "\r\n").status,
      413);
  std::mt19937 random(7);
  for (int i = 0; i < 10; ++i) {
    std::string noise(2000, '\0');
    for (char& byte : noise) byte = static_cast<char>(random());
    client()->send(noise);
  }
  EXPECT_TRUE(loop_.requests().empty());
  expect_it_serves();
}

TEST_F(AttackedPage, DamagedMessagesEndTheirConnectionOnly) {
  const auto good = client();
  ASSERT_TRUE(good->become_websocket("/operator"));
  struct Damage {
    std::uint8_t first_byte;
    std::string payload;
    bool masked = true;
  };
  const std::vector<Damage> damages = {{0x81, "not masked", false},
                                       {0xf1, "reserved bits"},
                                       {0x83, "reserved opcode"},
                                       {0x80, "continues nothing"},
                                       {0x81, "\xff\xfe no UTF-8"},
                                       {0x81, std::string(kMaxMessageBytes + 1, ' ')},
                                       {0x82, "binary"},
                                       {0x89, std::string(126, 'p')}};
  for (const char* path : {"/operator", "/live"}) {
    for (const Damage& damage : damages) {
      const auto attacker = client();
      ASSERT_TRUE(attacker->become_websocket(path));
      attacker->send_frame(damage.first_byte, damage.payload, damage.masked);
      EXPECT_TRUE(attacker->closed()) << damage.payload.substr(0, 20);
    }
  }
  const auto attacker = client();
  ASSERT_TRUE(attacker->become_websocket("/live"));
  attacker->send_text(R"({"type":["want"]})");
  EXPECT_TRUE(attacker->closed());
  EXPECT_EQ(good->ask_json(R"({"do":"status"})")["ok"], true);
  EXPECT_EQ(good->ask_json(R"([{"do":"start"}])")["ok"], false) << "no request, but no damage either";
  EXPECT_FALSE(client()->become_websocket("/nothing"));
}

TEST_F(AttackedPage, ATokenIsNotGuessed) {
  const auto guesser = client();
  ASSERT_TRUE(guesser->become_websocket("/operator"));
  for (int i = 0; i < 5; ++i)
    EXPECT_EQ(guesser->ask_json(R"({"do":"login","token":"guess"})")["error"], "not the token of this heeld");
  const auto refused = [&](PageClient& page) {
    return page.ask_json(R"({"do":"login","token":")" + kToken + R"("})").value("error", "");
  };
  EXPECT_THAT(refused(*guesser), testing::HasSubstr("too many tokens were tried"));
  const auto second = client();
  ASSERT_TRUE(second->become_websocket("/operator"));
  EXPECT_THAT(refused(*second), testing::HasSubstr("too many tokens were tried")) << "another connection";
  EXPECT_EQ(guesser->ask_json(R"({"do":"start"})")["needs_token"], true);
  std::string log;
  for (const LoggedLine& line : recent_->after(0, 100)) log += line.text + "\n";
  EXPECT_THAT(log, testing::HasSubstr("127.0.0.1: a wrong token was tried"));
  EXPECT_THAT(log, testing::HasSubstr("too many tokens were tried"));
  EXPECT_THAT(log, testing::Not(testing::HasSubstr(kToken)));
}

/// The time that an emergency stop of a new client takes until the control loop has it and it is answered.
double emergency_stop_s(std::uint16_t port) {
  const double t_asked_s = monotonic_s();
  PageClient client(port);
  EXPECT_EQ(client.ask("POST /estop").json()["ok"], true);
  return monotonic_s() - t_asked_s;
}

TEST_F(AttackedPage, AHundredConnectionsThatHangDoNotDelayAnEmergencyStop) {
  tick_.request_number = 1'000;  // the control loop answers at once
  push(1);
  std::vector<std::unique_ptr<PageClient>> hanging;
  for (int i = 0; i < 100; ++i) {
    hanging.push_back(client());
    hanging.back()->send(i % 2 == 0 ? "GET / HTTP/1.1\r\nHost: 127.0" : "");
  }
  double fastest_s = 1.0;
  for (int attempt = 0; attempt < 5; ++attempt) fastest_s = std::min(fastest_s, emergency_stop_s(port()));
  EXPECT_LT(fastest_s, 0.1);
  EXPECT_EQ(loop_.requests().size(), 5u);
  EXPECT_EQ(client()->ask("GET /api/info").status, 429) << "too many from this address";
  // A head that does not end within its time is given up, whatever else comes.
  for (const auto& one : hanging)
    EXPECT_TRUE(one->closed(seconds_from_ns(kRequestTime_ns) + test::kPatience_s));
  expect_it_serves();
}

TEST_F(AttackedPage, WebSocketsAreBoundedAndLeaveRoomForAnEmergencyStop) {
  std::vector<std::unique_ptr<PageClient>> open;
  for (const char* path : {"/live", "/operator"}) {
    for (std::size_t i = 0; i < kMaxViewers; ++i) {
      open.push_back(client());
      ASSERT_TRUE(open.back()->become_websocket(path)) << path << i;
    }
    EXPECT_FALSE(client()->become_websocket(path)) << path;
  }
  EXPECT_LT(emergency_stop_s(port()), test::kPatience_s);
  open.clear();
  EXPECT_TRUE(test::eventually([&] { return client()->become_websocket("/live"); }))
      << "the places are free again";
}

TEST_F(AttackedPage, AViewerThatDoesNotReadIsDroppedAndTheOthersAreServed) {
  PageClient slow(port(), 4096);
  ASSERT_TRUE(slow.become_websocket("/live"));
  const auto viewer = client();
  ASSERT_TRUE(viewer->become_websocket("/live"));
  ASSERT_TRUE(test::eventually(
      [&] { return client()->ask("GET /metrics").body.find("heel_page_viewers 2") != std::string::npos; }));
  std::uint64_t frame = 0;
  const bool dropped = test::eventually([&] {
    for (int i = 0; i < 60; ++i) {
      PoseEstimate pose;
      pose.frame_sequence = ++frame;
      queues_.poses.push(pose);
    }
    push(++frame);
    viewer->message_of("tick");
    for (const LoggedLine& line : recent_->after(0, 3))
      if (line.text.find("it does not read what it gets") != std::string::npos) return true;
    return false;
  });
  EXPECT_TRUE(dropped);
  expect_it_serves();
}

TEST_F(AttackedPage, AFloodOfMessagesEndsItsConnection) {
  const auto attacker = client();
  ASSERT_TRUE(attacker->become_websocket("/operator"));
  for (int i = 0; i < 300; ++i) attacker->send_text(R"({"do":"help"})");
  EXPECT_TRUE(attacker->closed());
  const auto requests = client();
  std::string flood;
  for (int i = 0; i < 200; ++i) flood += "GET /app.js HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n";
  requests->send(flood);
  EXPECT_TRUE(requests->closed());
  expect_it_serves();
}

}  // namespace
}  // namespace heel
