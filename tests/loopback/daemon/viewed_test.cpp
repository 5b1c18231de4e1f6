// heeld with its page: while clients of the page hang, look and attack, it drives on, and an emergency stop
// by the page reaches the wheels.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "loopback/daemon/emergency_stop.h"
#include "loopback/daemon/operated_heeld.h"
#include "support/exported.h"
#include "support/page_client.h"
#include "support/socket_client.h"
#include "support/temporary_folder.h"

namespace heel {
namespace {

using nlohmann::json;
using test::eventually;
using test::monotonic_s;
using test::PageClient;
using test::SocketClient;

class ViewedHeeld : public test::OperatedHeeldFixture {
 protected:
  void get_ready_with_page(const std::string& sections = "") {
    test::write_text(scene_.path("token"), "0123456789abcdef");
    std::filesystem::permissions(scene_.path("token"), std::filesystem::perms::owner_read);
    get_ready(operated_config("[view]\naddress = \"127.0.0.1:0\"\ntoken_file = \"token\"\n" + sections));
    const std::string log = daemon_->output();
    const std::string before = "the page is served at 127.0.0.1:0, port ";
    const std::size_t place = log.find(before);
    ASSERT_NE(place, std::string::npos) << log;
    port_ = static_cast<std::uint16_t>(std::stoi(log.substr(place + before.size())));
  }
  std::unique_ptr<PageClient> page() const { return std::make_unique<PageClient>(port_); }

  std::uint16_t port_ = 0;
};

TEST_F(ViewedHeeld, IsStartedAndLookedAtByThePage) {
  get_ready_with_page();
  const auto viewer = page(), operators = page();
  ASSERT_TRUE(viewer->become_websocket("/live"));
  ASSERT_TRUE(operators->become_websocket("/operator"));
  viewer->send_text(R"({"type":"want","picture":true})");
  EXPECT_EQ(operators->ask_json(R"({"do":"start"})")["needs_token"], true);
  EXPECT_EQ(operators->ask_json(R"({"do":"login","token":"0123456789abcdef"})")["may_write"], true);
  const bool drives = test::eventually([&] {
    operators->ask_json(R"({"do":"start"})");
    return speed() > 0.2;
  });
  EXPECT_TRUE(drives) << logs();
  json pose;
  do pose = viewer->message_of("pose");
  while (pose.is_object() && !pose["found"]);
  ASSERT_EQ(pose["quad"].size(), 4u) << logs();
  EXPECT_GT(pose["quad"][1][0], pose["quad"][0][0]) << "upright";
  EXPECT_GT(pose["quad"][2][1], pose["quad"][1][1]);
  EXPECT_GT(viewer->message_of("tick")["robot"]["battery_v"], 10.0);
  viewer->send_text(R"({"type":"picture_shown"})");  // one may have come before the pose
  std::string picture;
  do picture = viewer->message();
  while (!picture.empty() && picture[0] == '{');
  EXPECT_NE(picture.find("\xff\xd8\xff"), std::string::npos) << "a JPEG picture";
}

TEST_F(ViewedHeeld, DrivesOnUnderAttackAndAnEmergencyStopActsWhileEveryOtherRequestHangs) {
  get_ready_with_page("[telemetry]\ndirectory = \"run\"\n");
  SocketClient client(socket());
  std::vector<std::unique_ptr<PageClient>> attackers;
  for (int i = 0; i < 100; ++i) {
    attackers.push_back(page());
    attackers.back()->send(i % 3 == 0 ? "POST /estop HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Le"
                                      : std::string(1000, static_cast<char>(i)));
  }
  std::vector<double> asked_s;
  double fastest_answer_s = 1.0;
  for (int attempt = 0; attempt < 3; ++attempt) {
    ASSERT_TRUE(drives_after_start(client)) << logs();
    for (int i = 0; i < 20; ++i) {  // in place of those that were given up
      attackers.push_back(page());
      attackers.back()->send("GET / HTTP/1.1\r\nHost:");
    }
    ASSERT_TRUE(eventually([this] { return speed() > 0.0; })) << "it drives on" << logs();
    const auto stopper = page();
    asked_s.push_back(monotonic_s());
    EXPECT_EQ(stopper->ask("POST /estop").json()["ok"], true) << logs();
    fastest_answer_s = std::min(fastest_answer_s, monotonic_s() - asked_s.back());
    ASSERT_TRUE(comes_to_rest());
    EXPECT_EQ(command(client, "reset")["ok"], true);
  }
  EXPECT_LE(fastest_answer_s, 0.1);
  daemon_->signal(SIGTERM);
  ASSERT_EQ(daemon_->wait(), 0) << logs();
  const CsvTable ticks(test::exported(scene_.path("run")) + "/ticks.csv");
  double fastest_s = 1.0;
  for (const double t_asked_s : asked_s) {
    const test::EmergencyStop stop = test::emergency_stop_after(ticks, t_asked_s);
    ASSERT_TRUE(stop.found);
    EXPECT_EQ(stop.v_m_s, 0.0);
    fastest_s = std::min(fastest_s, stop.t_s - t_asked_s);
  }
  EXPECT_LE(fastest_s, 0.1) << "from the request until the command is on the wire";
}

}  // namespace
}  // namespace heel
