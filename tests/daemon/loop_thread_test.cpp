// What the thread of a loop logs when it starts, and what happens when the loop fails.
#include "daemon/loop_thread.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <thread>

#include "support/collected_log.h"
#include "support/priorities.h"

namespace heel {
namespace {

constexpr ThreadPlan kPlan{.role = ThreadRole::Control, .name = "heel-control", .priority = 60};

TEST(LoopThread, ARefusedPriorityIsLoggedWithTheReasonAndTheRemedyAndTheLoopRuns) {
  const test::CollectedLog log;
  const test::NoPriorityLimit no_limit;
  std::atomic<bool> failed{false}, ran{false};
  std::jthread([&] {
    test::drop_sys_nice();
    start_loop_thread(
        kPlan, true, [&] { ran = true; }, failed)
        .join();
  }).join();
  EXPECT_TRUE(ran);
  EXPECT_FALSE(failed);
  EXPECT_EQ(
      log.count("[warning] thread heel-control: real-time priority 60 refused (Operation not permitted)"), 1)
      << log.text();
  EXPECT_EQ(log.count("set LimitRTPRIO=60 or grant CAP_SYS_NICE"), 1) << log.text();
}

TEST(LoopThread, AGrantedPriorityGivesNoWarning) {
  const int error = test::answer_to_fifo_request(kPlan.priority);
  const test::CollectedLog log;
  std::atomic<bool> failed{false};
  start_loop_thread(
      kPlan, true, [] {}, failed)
      .join();
  EXPECT_EQ(log.count("refused"), error == 0 ? 0 : 1) << log.text();
}

TEST(LoopThread, ALoopThatThrowsIsLoggedAndReported) {
  const test::CollectedLog log;
  std::atomic<bool> failed{false};
  start_loop_thread(
      kPlan, false, [] { throw std::runtime_error("no memory"); }, failed)
      .join();
  EXPECT_TRUE(failed);
  EXPECT_EQ(log.count("[critical] thread heel-control failed: no memory"), 1) << log.text();
}

}  // namespace
}  // namespace heel
