// When the status is published, what happens without a broker, and what is logged, with a broker that the
// test plays.
#include "operator/mqtt/mqtt_publisher.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "config/config_load.h"
#include "operator/mqtt/scripted_line.h"
#include "operator/played_loop.h"
#include "support/collected_log.h"
#include "support/process.h"

namespace heel {
namespace {

using test::eventually;
using test::Published;

TelemetryConfig without_files() {
  TelemetryConfig config;
  config.black_box.clear();
  return config;
}

class MqttPublisherTest : public ::testing::Test {
 protected:
  ~MqttPublisherTest() override { end(); }

  void begin(double period_s) {
    MqttConfig config;
    config.address = "tcp://127.0.0.1:1883";
    config.topic = "site/robot";
    config.period_s = period_s;
    publisher_ = std::make_unique<MqttPublisher>(config, MqttParts{settings_, telemetry_, loop_},
                                                 std::make_unique<test::ScriptedLine>(broker_));
    thread_ = std::thread([this] { publisher_->run(); });
  }
  void end() {
    if (!thread_.joinable()) return;
    publisher_->stop();
    thread_.join();
  }
  /// The control loop reports this state.
  void report(SupervisorState state) {
    TickRecord tick;
    tick.state = state;
    tick.input.now_ns = monotonic_now_ns();
    ASSERT_TRUE(queues_.ticks.push(tick));
    telemetry_.drain(monotonic_now_ns());
  }
  std::vector<std::string> texts(const std::string& topic) {
    std::vector<std::string> found;
    for (const Published& one : broker_.all())
      if (one.first == topic) found.push_back(one.second);
    return found;
  }
  bool newest_state_is(const std::string& state) {
    const std::vector<std::string> all = texts("site/robot/status");
    return !all.empty() && nlohmann::json::parse(all.back())["state"] == state;
  }

  test::CollectedLog log_;
  test::PlayedBroker broker_;
  TelemetryQueues queues_;
  Telemetry telemetry_{queues_, without_files()};
  test::PlayedLoop loop_;
  Settings settings_{parse_config("", "heel.toml"), {[](const Config&) {}, [](const Config&) {}}};
  std::unique_ptr<MqttPublisher> publisher_;
  std::thread thread_;
};

TEST_F(MqttPublisherTest, SaysThatItIsThereThenTheStatusThenThatItHasGone) {
  begin(3600.0);
  ASSERT_TRUE(eventually([this] { return broker_.all().size() == 2; }));
  end();
  const std::vector<Published> all = broker_.all();
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[0], Published("site/robot/online", "online"));
  EXPECT_EQ(all[1].first, "site/robot/status");
  EXPECT_EQ(nlohmann::json::parse(all[1].second)["camera"]["frames"], 42);
  EXPECT_EQ(all[2], Published("site/robot/online", "offline"));
  EXPECT_TRUE(broker_.left);
}

TEST_F(MqttPublisherTest, PublishesAChangeOfTheStateAtOnceAndElseNothing) {
  report(SupervisorState::Idle);
  begin(3600.0);
  ASSERT_TRUE(eventually([this] { return newest_state_is("idle"); }));
  report(SupervisorState::Idle);
  test::sleep_s(0.3);
  EXPECT_EQ(texts("site/robot/status").size(), 1u) << "nothing has changed";
  report(SupervisorState::Emergency);
  EXPECT_TRUE(eventually([this] { return newest_state_is("emergency"); }));
  EXPECT_EQ(texts("site/robot/status").size(), 2u);
}

TEST_F(MqttPublisherTest, PublishesEveryPeriod) {
  begin(0.1);
  EXPECT_TRUE(eventually([this] { return texts("site/robot/status").size() > 5; }));
}

TEST_F(MqttPublisherTest, OfWhatABrokerDoesNotConfirmOnlyTheNewestIsSentLater) {
  begin(0.1);
  ASSERT_TRUE(eventually([this] { return !texts("site/robot/status").empty(); }));
  broker_.set(&test::PlayedBroker::confirms, false);
  test::sleep_s(0.2);  // for what was just being sent
  const std::size_t before = broker_.all().size();
  report(SupervisorState::Emergency);
  report(SupervisorState::Following);
  test::sleep_s(0.5);
  EXPECT_EQ(broker_.all().size(), before) << "nothing is sent to a broker that does not confirm";
  broker_.set(&test::PlayedBroker::confirms, true);
  EXPECT_TRUE(eventually([this] { return newest_state_is("following"); }));
  for (const std::string& text : texts("site/robot/status"))
    EXPECT_NE(nlohmann::json::parse(text)["state"], "emergency") << "it was over";
}

TEST_F(MqttPublisherTest, TriesAgainMoreAndMoreSeldomAndLogsEachReasonOnce) {
  broker_.problems = {"refused", "refused", "no answer"};
  begin(3600.0);
  ASSERT_TRUE(eventually([this] { return texts("site/robot/status").size() == 1; }));
  ASSERT_EQ(broker_.attempts(), 4u);
  for (std::size_t i = 1; i < 4; ++i)
    EXPECT_GE(broker_.t_attempts_ns[i] - broker_.t_attempts_ns[i - 1], (1 << (i - 1)) * kNsPerS) << i;
  end();
  EXPECT_EQ(log_.count("refused"), 1) << log_.text();
  EXPECT_EQ(log_.count("no answer"), 1) << log_.text();
  EXPECT_EQ(log_.count("connected to"), 1) << log_.text();
}

TEST_F(MqttPublisherTest, IsThereAgainAfterALoss) {
  begin(3600.0);
  for (std::size_t losses = 0; losses < 2; ++losses) {
    ASSERT_TRUE(eventually([&] { return texts("site/robot/status").size() == losses + 1; })) << losses;
    broker_.set(&test::PlayedBroker::breaks, true);
  }
  ASSERT_TRUE(eventually([this] { return texts("site/robot/status").size() == 3; }));
  EXPECT_EQ(texts("site/robot/online").size(), 3u) << "the broker has published its will";
  end();
  EXPECT_EQ(log_.count("the connection is lost"), 1) << log_.text();
  EXPECT_EQ(log_.count("connected to"), 2) << log_.text();
}

TEST_F(MqttPublisherTest, StopsAtOnceWhileItWaitsForTheNextAttempt) {
  broker_.problems = {"a", "b", "c", "d", "e"};
  begin(3600.0);
  ASSERT_TRUE(eventually([this] { return broker_.attempts() == 3; }));
  const double begin_s = test::monotonic_s();  // the next attempt is in 4 s
  end();
  EXPECT_LT(test::monotonic_s() - begin_s, 3.0);
  EXPECT_TRUE(broker_.all().empty());
}

TEST_F(MqttPublisherTest, LeavesTheFarewellToTheWillOfABrokerThatHangs) {
  begin(0.1);
  ASSERT_TRUE(eventually([this] { return !texts("site/robot/status").empty(); }));
  broker_.set(&test::PlayedBroker::confirms, false);
  test::sleep_s(0.2);
  const double begin_s = test::monotonic_s();
  end();
  EXPECT_LT(test::monotonic_s() - begin_s, 2.0);
  EXPECT_THAT(texts("site/robot/online"), ::testing::ElementsAre("online"));
  EXPECT_FALSE(broker_.left);
}

TEST(MqttRetry, PausesDoubleUpToHalfAMinute) {
  Backoff backoff;
  for (const TimeNs expected_s : {1, 2, 4, 8, 16, 30, 30}) EXPECT_EQ(backoff.next(), expected_s * kNsPerS);
  backoff.reset();
  EXPECT_EQ(backoff.next(), kNsPerS);
}

TEST(MqttRetry, AReasonIsNewsOnceAndTooManyAreNone) {
  ReasonsSeen reasons;
  EXPECT_TRUE(reasons.is_news("a"));
  EXPECT_FALSE(reasons.is_news("a"));
  std::size_t news = 1;
  for (int i = 0; i < 100; ++i) news += reasons.is_news(std::to_string(i)) ? 1 : 0;
  EXPECT_EQ(news, ReasonsSeen::kMax);
  reasons.forget();
  EXPECT_TRUE(reasons.is_news("a"));
}

}  // namespace
}  // namespace heel
