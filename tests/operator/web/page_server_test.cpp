// The page's server over a real socket: files, live data, the operators' protocol, settings and metrics.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <regex>
#include <sstream>
#include <string>

#include "config/config_table.h"
#include "files/jpeg_decoder.h"
#include "operator/web/page_fixture.h"

namespace heel {
namespace {

using nlohmann::json;
using test::HttpAnswer;
using test::kToken;
using test::PageClient;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

using Page = test::PageFixture;

TEST_F(Page, ServesItsFilesAndNoOthers) {
  const auto browser = client();
  const HttpAnswer start = browser->ask("GET /");
  EXPECT_EQ(start.status, 200);
  EXPECT_EQ(start.body, "<!doctype html><title>heel</title>");
  EXPECT_THAT(start.head, HasSubstr("Content-Type: text/html; charset=utf-8\r\n"));
  EXPECT_THAT(start.head, HasSubstr("Content-Security-Policy: default-src 'self';"));
  EXPECT_EQ(browser->ask("GET /app.js?v=2").body, "export const a = 1;");
  EXPECT_EQ(browser->ask("GET /lib/dygraphs.min.js").body, "var Dygraph;");
  for (const char* other : {"/secret.txt", "/../token", "/%2e%2e/token", "//etc/passwd", "/app.js/", "/lib"})
    EXPECT_EQ(browser->ask(std::string("GET ") + other).status, 404) << other;
  EXPECT_EQ(browser->ask("DELETE /app.js").status, 405);
  EXPECT_EQ(browser->ask("POST /api/info").status, 405);
  EXPECT_EQ(browser->ask("GET /estop").status, 405);
  EXPECT_TRUE(loop_.requests().empty());
}

TEST_F(Page, SaysWhatThisHeeldIs) {
  const json info = client()->ask("GET /api/info").json();
  EXPECT_EQ(info["protocol"], 1);
  EXPECT_EQ(info["has_token"], true);
  EXPECT_EQ(info["recording"], false);
  EXPECT_EQ(info["camera"]["width"], 64);
  EXPECT_NEAR(info["camera"]["hfov_rad"], 2.0 * std::atan(32.0 / 50.0), 0.02);
  EXPECT_EQ(info["set_distance_m"], 2.0);
  EXPECT_GT(info["robot_outline"]["front_m"], 0.1);
}

TEST_F(Page, HasEveryKeyOfTheConfigurationWithWhatMayBeDoneWithIt) {
  const auto operator_page = client();
  ASSERT_TRUE(operator_page->become_websocket("/operator"));
  EXPECT_EQ(operator_page->ask_json(R"({"do":"login","token":")" + kToken + R"("})")["may_write"], true);
  EXPECT_EQ(operator_page->ask_json(R"({"do":"set","values":{"gate.v_max_m_s":0.3}})")["ok"], true);

  const json config = client()->ask("GET /api/config").json();
  EXPECT_EQ(config["file"], folder_.file("heel.toml"));
  ASSERT_EQ(config["keys"].size(), config_keys().size());
  std::map<std::string, json> rows;
  for (const json& row : config["keys"]) rows[row["key"]] = row;
  const json& speed = rows["gate.v_max_m_s"];
  EXPECT_EQ(speed["value"], 0.3);
  EXPECT_EQ(speed["file_value"], 0.5);
  EXPECT_EQ(speed["default"], Config().gate.v_max_m_s);
  EXPECT_EQ(speed["limit"], "tighter-only");
  EXPECT_EQ(speed["safer"], "smaller");
  EXPECT_EQ(speed["live"], true);
  EXPECT_EQ(speed["unit"], "m/s");
  EXPECT_EQ(rows["camera.source"]["live"], false);
  EXPECT_EQ(rows["camera.source"]["min"], nullptr);
  EXPECT_EQ(rows["view.hosts"]["value"], json({"robot.local"}));
  EXPECT_EQ(rows["gate.deceleration_m_s2"]["limit"], "file-only");
  EXPECT_EQ(rows["gate.deceleration_m_s2"]["live"], false);
}

TEST_F(Page, OperatorsReadWithoutATokenAndWriteWithIt) {
  const auto page = client();
  ASSERT_TRUE(page->become_websocket("/operator"));
  EXPECT_EQ(page->ask_json(R"({"do":"status"})")["ok"], true);
  EXPECT_EQ(page->ask_json(R"({"id":1,"do":"start"})")["needs_token"], true);
  EXPECT_EQ(page->ask_json("{\"do\":\"status\",\n\"id\":2}\n")["id"], 2) << "an end of line is a blank";
  EXPECT_EQ(page->ask_json("{\"do\":\"help\"}\n{\"do\":\"start\"}")["ok"], false) << "one request a message";
  EXPECT_EQ(page->ask_json(R"({"id":3,"do":"login","token":"0123456789abcdef-tokem"})")["ok"], false);
  EXPECT_EQ(page->ask_json(R"({"id":4,"do":"login"})")["id"], 4);
  EXPECT_TRUE(loop_.requests().empty());
  EXPECT_EQ(loop_.signs_of_life(), 0);
  EXPECT_EQ(page->ask_json(R"({"id":5,"do":"login","token":")" + kToken + R"("})")["may_write"], true);
  EXPECT_EQ(page->ask_json(R"({"id":6,"do":"start"})")["outcome"], "done");
  EXPECT_EQ(loop_.requests(), std::vector{OperatorCommand::Start});
  EXPECT_THAT(loop_.answers(), ElementsAre("start: done"));

  const auto other = client();
  ASSERT_TRUE(other->become_websocket("/operator"));
  EXPECT_EQ(other->ask_json(R"({"do":"stop"})")["needs_token"], true) << "the token is of one connection";
}

TEST_F(Page, AnEmergencyStopNeedsNothingAndSaysWhatBecameOfIt) {
  tick_.request_number = 1;
  tick_.outcome = OperatorOutcome::Done;
  push(1);
  EXPECT_EQ(client()->ask("POST /estop").json(), json({{"ok", true}, {"outcome", "done"}}));
  EXPECT_EQ(client()->ask("POST /estop").json(), json({{"ok", true}, {"outcome", "sent"}}))
      << "the control loop has not said so yet";
  EXPECT_EQ(loop_.requests(), (std::vector{OperatorCommand::EStop, OperatorCommand::EStop}));
  EXPECT_THAT(loop_.answers(), ElementsAre("estop: done", "estop: sent"));
}

TEST_F(Page, LiveRecordsComeWhileSomebodyLooks) {
  push(1);
  EXPECT_FALSE(feed_.take().tick.has_value()) << "nobody looks";
  const auto viewer = client();
  ASSERT_TRUE(viewer->become_websocket("/live"));
  ASSERT_TRUE(test::eventually(
      [&] { return client()->ask("GET /metrics").body.find("heel_page_viewers 1") != std::string::npos; }));
  tick_.state = SupervisorState::Following;
  tick_.command.limited_by = kGateSpeed | kGateObstacle;
  push(2);
  const json tick = viewer->message_of("tick");
  EXPECT_EQ(tick["state"], "following");
  EXPECT_EQ(tick["limited_by"], json({"speed", "obstacle"}));
  EXPECT_EQ(tick["lateness_us"], 30.0);
  const json pose = viewer->message_of("pose");
  EXPECT_EQ(pose["frame"], 2);
  EXPECT_EQ(pose["quad"], json::parse("[[15,12],[35,12],[35,42],[15,42]]"));
  EXPECT_NEAR(pose["latency_ms"]["capture_to_vision"], 10.0, 0.01);
  EXPECT_NEAR(pose["latency_ms"]["to_command"], 20.0, 0.01);
  spdlog::warn("something to see");
  while (viewer->message_of("event").value("text", "something to see") != "something to see") {
  }
  EXPECT_EQ(client()->ask("GET /api/log?n=1").json()["events"].size(), 1u);
  const json log = client()->ask("GET /api/log?n=10").json();
  const auto logged = std::find_if(log["events"].begin(), log["events"].end(),
                                   [](const json& event) { return event["text"] == "something to see"; });
  ASSERT_NE(logged, log["events"].end()) << "the server may have said something since: " << log;
  EXPECT_EQ((*logged)["severity"], "warning");
}

/// The head of a picture and its JPEG bytes.
struct Picture {
  json head;
  std::string jpeg;
};
Picture picture_in(const std::string& message) {
  const auto byte = [&](std::size_t i) { return std::size_t{static_cast<std::uint8_t>(message[i])}; };
  const std::size_t length = byte(0) | byte(1) << 8 | byte(2) << 16 | byte(3) << 24;
  return {json::parse(message.substr(4, length)), message.substr(4 + length)};
}

TEST_F(Page, OnePictureIsOnItsWayToEachViewer) {
  const auto viewer = client();
  ASSERT_TRUE(viewer->become_websocket("/live"));
  viewer->send_text(R"({"type":"want","picture":true})");
  ASSERT_TRUE(test::eventually([&] { return feed_.wants_pictures(); }));
  telemetry_.drain(0);  // opens the queue of frames
  const auto next_picture = [&] {
    for (std::string message = viewer->message(); !message.empty(); message = viewer->message())
      if (message[0] != '{') return picture_in(message);
    return Picture{};
  };
  push(5);
  const Picture first = next_picture();
  EXPECT_EQ(first.head["frame"], 5);
  EXPECT_EQ(first.head["full_width"], 64);
  EXPECT_GE(first.head["age_ms"], 20.0);
  const auto* jpeg = reinterpret_cast<const std::uint8_t*>(first.jpeg.data());
  std::vector<std::uint8_t> grey(64 * 48);
  JpegDecoder decoder;
  ASSERT_TRUE(decoder.decode(jpeg, first.jpeg.size(), 64, 48, grey.data())) << decoder.problem();
  EXPECT_NEAR(grey[1000], 100, 2);

  for (std::uint64_t frame = 6; frame < 10; ++frame) {
    test::sleep_s(0.04);
    push(frame);
    EXPECT_EQ(viewer->message_of("pose")["frame"], frame) << "no picture before it";
  }
  EXPECT_THAT(client()->ask("GET /metrics").body, HasSubstr("heel_page_pictures_total 1\n"))
      << "none is encoded";
  viewer->send_text(R"({"type":"picture_shown","frame":5})");
  ASSERT_TRUE(test::eventually([&] {
    push(10 + tick_.tick);
    return client()->ask("GET /metrics").body.find("heel_page_pictures_total 2\n") != std::string::npos;
  }));
  EXPECT_GT(next_picture().head["frame"], 9);
  viewer->send_text(R"({"type":"want","picture":false})");
  EXPECT_TRUE(test::eventually([&] { return !feed_.wants_pictures(); }));
}

/// Name with labels → value, of every sample; fails for a line that is none.
std::map<std::string, double> samples_of(const std::string& text) {
  const std::regex sample(R"(([a-z_]+(\{[a-z]+="[^"]*"\})?) ([-+.0-9eInf]+|Nan))");
  std::map<std::string, double> samples;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::smatch parts;
    if (line.starts_with("# HELP ") || line.starts_with("# TYPE ")) continue;
    EXPECT_TRUE(std::regex_match(line, parts, sample)) << line;
    if (parts.size() > 3) samples[parts[1]] = std::stod(parts[3]);
  }
  return samples;
}

TEST_F(Page, MonitoringReadsTheNewestRecords) {
  tick_.state = SupervisorState::Waiting;
  tick_.input.robot.has_sip = true;
  tick_.input.robot.battery_v = 12.25;
  tick_.input.robot.reconnects = 3;
  tick_.input.robot.phase = LinkPhase::Running;
  queues_.captures.push({.captured = 90, .dropped_unread = 4});
  queues_.control_events.push({.kind = EventKind::Overrun, .a = 11});
  for (std::uint64_t frame = 1; frame <= 5; ++frame) push(frame);
  const HttpAnswer answer = client()->ask("GET /metrics");
  EXPECT_THAT(answer.head, HasSubstr("Content-Type: text/plain; version=0.0.4"));
  std::map<std::string, double> samples = samples_of(answer.body);
  EXPECT_EQ(samples["heel_control_ticks_total"], 5);
  EXPECT_EQ(samples["heel_control_lateness_seconds_count"], 5);
  EXPECT_EQ(samples["heel_control_lateness_seconds_bucket{le=\"2e-05\"}"], 0);
  EXPECT_EQ(samples["heel_control_lateness_seconds_bucket{le=\"5e-05\"}"], 5);
  EXPECT_NEAR(samples["heel_control_lateness_seconds_sum"], 5 * 30e-6, 1e-9);
  EXPECT_EQ(samples["heel_control_overruns_total"], 11);
  EXPECT_EQ(samples["heel_state{name=\"waiting\"}"], 1);
  EXPECT_EQ(samples["heel_state{name=\"following\"}"], 0);
  EXPECT_EQ(samples["heel_robot_link{name=\"running\"}"], 1);
  EXPECT_EQ(samples["heel_battery_volts"], 12.25);
  EXPECT_EQ(samples["heel_robot_reconnects_total"], 3);
  EXPECT_EQ(samples["heel_frames_total"], 90);
  EXPECT_EQ(samples["heel_frames_dropped_unread_total"], 4);
}

}  // namespace
}  // namespace heel
