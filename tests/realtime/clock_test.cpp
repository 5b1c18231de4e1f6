// Absolute deadlines: lateness, overruns, no drift.
#include "realtime/clock.h"

#include <gtest/gtest.h>

namespace heel {
namespace {

TEST(Clock, SleepsUntilAnAbsoluteTimeAndNotWhenItHasPassed) {
  const TimeNs start_ns = monotonic_now_ns();
  sleep_until_ns(start_ns + 5 * kNsPerMs);
  EXPECT_GE(monotonic_now_ns(), start_ns + 5 * kNsPerMs);
  const TimeNs now_ns = monotonic_now_ns();
  sleep_until_ns(now_ns - 1000 * kNsPerS);
  EXPECT_LT(monotonic_now_ns() - now_ns, 500 * kNsPerS);
}

TEST(PeriodicDeadline, StaysOnTheGridAfterLateWakeUps) {
  PeriodicDeadline deadline(20, 1000);
  EXPECT_EQ(deadline.next_ns(), 1020);
  EXPECT_EQ(deadline.advance(1020), 0);
  EXPECT_EQ(deadline.advance(1047), 7);
  EXPECT_EQ(deadline.next_ns(), 1060);
  EXPECT_EQ(deadline.overruns(), 0u);
}

TEST(PeriodicDeadline, SkipsAndCountsDeadlinesThatHavePassed) {
  PeriodicDeadline deadline(20, 0);
  EXPECT_EQ(deadline.advance(20 + 45), 45);  // the deadlines at 40 and 60 have also passed
  EXPECT_EQ(deadline.overruns(), 2u);
  EXPECT_EQ(deadline.next_ns(), 80);
  EXPECT_EQ(deadline.advance(100), 20);  // exactly one period late: the deadline at 100 is missed too
  EXPECT_EQ(deadline.overruns(), 3u);
  EXPECT_EQ(deadline.next_ns(), 120);
}

TEST(PeriodicDeadline, WakingEarlyCountsAsOnTime) {
  PeriodicDeadline deadline(20, 0);
  EXPECT_EQ(deadline.advance(19), 0);
  EXPECT_EQ(deadline.next_ns(), 40);
}

TEST(PeriodicDeadline, ARestartMovesTheDeadlinesAndKeepsTheOverruns) {
  PeriodicDeadline deadline(20, 0);
  deadline.advance(20 + 45);
  deadline.restart(1003);
  EXPECT_EQ(deadline.next_ns(), 1023);
  EXPECT_EQ(deadline.advance(1025), 2);
  EXPECT_EQ(deadline.overruns(), 2u);
}

}  // namespace
}  // namespace heel
