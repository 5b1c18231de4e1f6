// The schedule table, and how a thread applies its row.
#include "realtime/schedule.h"

#include <gtest/gtest.h>
#include <pthread.h>
#include <sched.h>
#include <sys/prctl.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <set>
#include <string>
#include <thread>

#include "support/priorities.h"

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
  EXPECT_EQ(plan_of(schedule, ThreadRole::Telemetry).priority, 0)
      << "telemetry writes to disk and formats text";
  EXPECT_EQ(plan_of(schedule, ThreadRole::Operator).priority, 0) << "its load comes from outside";
  EXPECT_EQ(plan_of(schedule, ThreadRole::View).priority, 0) << "its load comes from the network";
  EXPECT_EQ(plan_of(schedule, ThreadRole::Settings).priority, 0) << "it waits for the disk";
}

TEST(Schedule, CoresFollowTheConfigurationAndAreAnyByDefault) {
  for (const ThreadPlan& plan : make_schedule(Config{})) EXPECT_EQ(plan.core, -1) << plan.name;
  Config config;
  config.runtime.core_control = 3;
  config.runtime.core_capture = 2;
  config.runtime.core_vision = 1;
  const Schedule schedule = make_schedule(config);
  EXPECT_EQ(plan_of(schedule, ThreadRole::Control).core, 3);
  EXPECT_EQ(plan_of(schedule, ThreadRole::Capture).core, 2);
  EXPECT_EQ(plan_of(schedule, ThreadRole::Vision).core, 1);
}

TEST(Schedule, RowsStandInTheOrderOfTheirRoles) {
  const Schedule schedule = make_schedule(Config{});
  for (std::size_t i = 0; i < schedule.size(); ++i)
    EXPECT_EQ(static_cast<std::size_t>(schedule[i].role), i) << schedule[i].name;
}

TEST(Schedule, NamesAreDistinctAndFitTheKernelsFifteenCharacters) {
  std::set<std::string> names;
  for (const ThreadPlan& plan : make_schedule(Config{})) {
    EXPECT_LE(std::strlen(plan.name), 15u) << plan.name;
    EXPECT_TRUE(names.insert(plan.name).second) << plan.name;
  }
}

/// What `enter_thread` returned, and the kernel's values for the thread.
struct Entered {
  ThreadEntry entry;
  std::string name;
  int policy = -1;
  bool resets_on_fork = false;  ///< threads that it starts have ordinary scheduling
  int priority = -1;
  long timer_slack_ns = -1;
};

Entered observe_this_thread(const ThreadEntry& entry) {
  Entered entered;
  entered.entry = entry;
  std::array<char, 32> name{};
  pthread_getname_np(pthread_self(), name.data(), name.size());
  entered.name = name.data();
  const int scheduler = sched_getscheduler(0);
  entered.policy = scheduler & ~SCHED_RESET_ON_FORK;
  entered.resets_on_fork = (scheduler & SCHED_RESET_ON_FORK) != 0;
  sched_param parameters{};
  sched_getparam(0, &parameters);
  entered.priority = parameters.sched_priority;
  entered.timer_slack_ns = prctl(PR_GET_TIMERSLACK);
  return entered;
}

/// Calls `before` and then `enter_thread` in a new thread.
template <typename Before>
Entered enter(const ThreadPlan& plan, bool realtime, Before before) {
  Entered entered;
  std::jthread([&] {
    before();
    entered = observe_this_thread(enter_thread(plan, realtime));
  }).join();
  return entered;
}

Entered enter(const ThreadPlan& plan, bool realtime) {
  return enter(plan, realtime, [] {});
}

constexpr ThreadPlan kPlan{.role = ThreadRole::Control, .name = "heel-control", .priority = 60};

TEST(EnterThread, NamesTheThreadAndKeepsOrdinarySchedulingWithoutRealTime) {
  const Entered entered = enter(kPlan, false);
  EXPECT_EQ(entered.name, "heel-control");
  EXPECT_FALSE(entered.entry.realtime);
  EXPECT_EQ(entered.entry.error, 0);
  EXPECT_EQ(entered.policy, SCHED_OTHER);
  EXPECT_EQ(entered.timer_slack_ns, 1);
}

// Root gets the priority, a container without CAP_SYS_NICE does not. The kernel's own answer decides.
TEST(EnterThread, HasThePriorityWhereTheKernelGrantsIt) {
  const int error = test::answer_to_fifo_request(kPlan.priority);
  const Entered entered = enter(kPlan, true);
  EXPECT_EQ(entered.name, "heel-control");
  EXPECT_EQ(entered.entry.realtime, error == 0);
  EXPECT_EQ(entered.entry.error, error);
  EXPECT_EQ(entered.policy, error == 0 ? SCHED_FIFO : SCHED_OTHER);
  EXPECT_EQ(entered.priority, error == 0 ? kPlan.priority : 0);
  EXPECT_EQ(entered.resets_on_fork, error == 0);
}

TEST(EnterThread, ARefusalIsReportedAndTheThreadKeepsOrdinaryScheduling) {
  const test::NoPriorityLimit no_limit;
  const Entered entered = enter(kPlan, true, test::drop_sys_nice);
  EXPECT_FALSE(entered.entry.realtime);
  EXPECT_EQ(entered.entry.error, EPERM);
  EXPECT_EQ(entered.policy, SCHED_OTHER);
  EXPECT_EQ(entered.name, "heel-control");
}

TEST(EnterThread, HasItsCoreAlone) {
  cpu_set_t cores;
  CPU_ZERO(&cores);
  ThreadEntry entry;
  std::jthread([&] {
    entry = enter_thread({.role = ThreadRole::Vision, .name = "heel-vision", .core = 0}, true);
    sched_getaffinity(0, sizeof cores, &cores);
  }).join();
  EXPECT_EQ(entry.core_error, 0);
  EXPECT_EQ(CPU_COUNT(&cores), 1);
  EXPECT_TRUE(CPU_ISSET(0, &cores));
}

TEST(EnterThread, APriorityThatDoesNotExistIsRefused) {
  const Entered entered =
      enter({.role = ThreadRole::Control, .name = "heel-control", .priority = 1000}, true);
  EXPECT_FALSE(entered.entry.realtime);
  EXPECT_EQ(entered.entry.error, EINVAL);
  EXPECT_EQ(entered.policy, SCHED_OTHER);
}

}  // namespace
}  // namespace heel
