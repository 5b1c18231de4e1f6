// The schedule table and what a thread makes of its row.
#include "realtime/schedule.h"

#include <gtest/gtest.h>
#include <pthread.h>
#include <sched.h>
#include <sys/prctl.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <set>
#include <string>
#include <thread>

namespace heel {
namespace {

TEST(Schedule, RowsFollowTheConfiguration) {
  Config config;
  config.camera.rate_hz = 25.0;
  config.control.rate_hz = 50.0;
  config.runtime.priority_control = 71;
  config.runtime.priority_capture = 52;
  config.runtime.priority_vision = 33;
  const Schedule schedule = make_schedule(config);

  const ThreadPlan& control = plan_of(schedule, ThreadRole::Control);
  EXPECT_EQ(control.priority, 71);
  EXPECT_EQ(control.rate_hz, 50.0);
  EXPECT_EQ(control.deadline_ns, 20 * kNsPerMs);
  const ThreadPlan& vision = plan_of(schedule, ThreadRole::Vision);
  EXPECT_EQ(vision.priority, 33);
  EXPECT_EQ(vision.deadline_ns, 40 * kNsPerMs);
  EXPECT_EQ(plan_of(schedule, ThreadRole::Capture).priority, 52);
  EXPECT_EQ(plan_of(schedule, ThreadRole::Telemetry).priority, 0) << "disks and text are never real time";
}

TEST(Schedule, NamesAreDistinctAndFitTheKernelsFifteenCharacters) {
  std::set<std::string> names;
  for (const ThreadPlan& plan : make_schedule(Config{})) {
    EXPECT_LE(std::strlen(plan.name), 15u) << plan.name;
    EXPECT_TRUE(names.insert(plan.name).second) << plan.name;
  }
}

// Runs `enter_thread` in a thread of its own and looks at it from inside.
struct Inside {
  ThreadEntry entry;
  std::string name;
  int policy = -1;
  int priority = -1;
  long timer_slack_ns = -1;
};

Inside enter(const ThreadPlan& plan, bool realtime) {
  Inside inside;
  std::jthread([&] {
    inside.entry = enter_thread(plan, realtime);
    std::array<char, 32> name{};
    pthread_getname_np(pthread_self(), name.data(), name.size());
    inside.name = name.data();
    sched_param parameters{};
    pthread_getschedparam(pthread_self(), &inside.policy, &parameters);
    inside.policy &= ~SCHED_RESET_ON_FORK;
    inside.priority = parameters.sched_priority;
    inside.timer_slack_ns = prctl(PR_GET_TIMERSLACK);
  }).join();
  return inside;
}

TEST(EnterThread, NamesTheThreadAndLeavesItOrdinaryWithoutRealTime) {
  const Inside inside = enter({.role = ThreadRole::Vision, .name = "heel-vision", .priority = 40}, false);
  EXPECT_EQ(inside.name, "heel-vision");
  EXPECT_FALSE(inside.entry.realtime);
  EXPECT_EQ(inside.entry.error, 0);
  EXPECT_EQ(inside.policy, SCHED_OTHER);
  EXPECT_EQ(inside.timer_slack_ns, 1);
}

TEST(EnterThread, PriorityIsGrantedOrTheRefusalNamed) {
  const Inside inside = enter({.role = ThreadRole::Control, .name = "heel-control", .priority = 60}, true);
  EXPECT_EQ(inside.name, "heel-control");
  if (inside.entry.realtime) {
    EXPECT_EQ(inside.policy, SCHED_FIFO);
    EXPECT_EQ(inside.priority, 60);
    EXPECT_EQ(inside.entry.error, 0);
  } else {
    EXPECT_EQ(inside.entry.error, EPERM);
    EXPECT_EQ(inside.policy, SCHED_OTHER);
  }
}

TEST(EnterThread, GoesOnWhenRefused) {
  const Inside inside = enter({.role = ThreadRole::Control, .name = "heel-control", .priority = 1000}, true);
  EXPECT_FALSE(inside.entry.realtime);
  EXPECT_EQ(inside.entry.error, EINVAL);
  EXPECT_EQ(inside.policy, SCHED_OTHER);
}

}  // namespace
}  // namespace heel
