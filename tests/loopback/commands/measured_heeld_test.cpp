// What the command heel measures of a running heeld: the way of each frame to its command, and the cost.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "loopback/daemon/live_heeld.h"
#include "realtime/schedule.h"

namespace heel {
namespace {

using Latency = test::LiveHeeld;

TEST_F(Latency, IsTheWayOfEachFrameToItsCommand) {
  start_following(live_config(false, "", "[telemetry]\ndirectory = \"" + scene_.path("") + "\"\n"));
  test::sleep_s(1.0);
  daemon_->signal(SIGTERM);
  ASSERT_EQ(daemon_->wait(), 0) << logs();
  const test::Outcome outcome =
      test::run_program({test::built_program("heel"), "latency", scene_.path(""), "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto told = nlohmann::json::parse(outcome.out);
  EXPECT_GT(told["commands"], 15);
  EXPECT_LE(told["commands"], told["frames"]);
  ASSERT_EQ(told["hops"].size(), 5u);
  double sum_ms = 0.0;
  for (const auto& hop : told["hops"]) {
    EXPECT_EQ(hop["count"], told["commands"]) << hop;
    EXPECT_GE(hop["p50_ms"], 0.0) << hop;
    EXPECT_LE(hop["p50_ms"], hop["p99_ms"]) << hop;
    EXPECT_LE(hop["p99_ms"], hop["max_ms"]) << hop;
    sum_ms += hop["max_ms"].get<double>();
  }
  EXPECT_GT(told["hops"][2]["p50_ms"], 0.1) << "vision takes time";
  EXPECT_LE(told["total"]["max_ms"], sum_ms + 1e-6);
  EXPECT_EQ(told["slowest_ms"].size(), 6u);
}

TEST(BenchDaemon, MeasuresAHeeldThatFollows) {
  const test::Outcome outcome =
      test::run_program({test::built_program("heel"), "bench", "daemon", "--seconds", "1", "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto told = nlohmann::json::parse(outcome.out);
  double sum = 0.0;
  std::set<std::string> names;
  for (const auto& thread : told["threads"]) {
    names.insert(thread["name"]);
    sum += thread["core_share"].get<double>();
  }
  for (const ThreadPlan& plan : make_schedule({}))
    EXPECT_EQ(names.contains(plan.name), plan.role != ThreadRole::View && plan.role != ThreadRole::Mqtt)
        << plan.name << ": no page is served here, and no broker told";
  EXPECT_NEAR(told["core_share"]["all"], sum, 1e-9);
  EXPECT_GT(sum, 0.001) << "vision works";
  EXPECT_GT(told["memory"]["resident_mb"], 5.0);
  EXPECT_EQ(told["memory"]["largest"].size(), 10u);
}

}  // namespace
}  // namespace heel
