// The schedule table and what a thread makes of its row.
#include "realtime/schedule.h"

#include <gtest/gtest.h>
#include <linux/capability.h>
#include <pthread.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <set>
#include <string>
#include <thread>

#include "support/collected_log.h"

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

/// What `enter_thread` said, and what the kernel says of the thread.
struct Entered {
  ThreadEntry entry;
  std::string name;
  int policy = -1;
  int priority = -1;
  long timer_slack_ns = -1;
};

Entered observe_this_thread(const ThreadEntry& entry) {
  Entered entered;
  entered.entry = entry;
  std::array<char, 32> name{};
  pthread_getname_np(pthread_self(), name.data(), name.size());
  entered.name = name.data();
  entered.policy = sched_getscheduler(0) & ~SCHED_RESET_ON_FORK;
  sched_param parameters{};
  sched_getparam(0, &parameters);
  entered.priority = parameters.sched_priority;
  entered.timer_slack_ns = prctl(PR_GET_TIMERSLACK);
  return entered;
}

/// In a thread of its own: calls `before`, then `enter_thread`.
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

/// What the kernel answers to a thread of this process that asks for SCHED_FIFO at `priority`: 0 or an errno.
int kernels_answer(int priority) {
  int error = 0;
  std::jthread([&] {
    sched_param parameters{};
    parameters.sched_priority = priority;
    error = sched_setscheduler(0, SCHED_FIFO, &parameters) == 0 ? 0 : errno;
  }).join();
  return error;
}

/// While it lives the process may raise no thread's priority by its resource limit.
class NoPriorityLimit {
 public:
  NoPriorityLimit() {
    getrlimit(RLIMIT_RTPRIO, &before_);
    const rlimit none{.rlim_cur = 0, .rlim_max = before_.rlim_max};
    setrlimit(RLIMIT_RTPRIO, &none);
  }
  NoPriorityLimit(const NoPriorityLimit&) = delete;
  NoPriorityLimit& operator=(const NoPriorityLimit&) = delete;
  ~NoPriorityLimit() { setrlimit(RLIMIT_RTPRIO, &before_); }

 private:
  rlimit before_{};
};

/// Takes CAP_SYS_NICE from the calling thread, and from it alone.
void drop_sys_nice() {
  __user_cap_header_struct header{.version = _LINUX_CAPABILITY_VERSION_3, .pid = 0};
  std::array<__user_cap_data_struct, _LINUX_CAPABILITY_U32S_3> sets{};
  ASSERT_EQ(syscall(SYS_capget, &header, sets.data()), 0);
  sets[CAP_SYS_NICE / 32].effective &= ~(1u << (CAP_SYS_NICE % 32));
  ASSERT_EQ(syscall(SYS_capset, &header, sets.data()), 0);
}

constexpr ThreadPlan kPlan{.role = ThreadRole::Control, .name = "heel-control", .priority = 60};

TEST(EnterThread, NamesTheThreadAndLeavesItOrdinaryWithoutRealTime) {
  const Entered entered = enter(kPlan, false);
  EXPECT_EQ(entered.name, "heel-control");
  EXPECT_FALSE(entered.entry.realtime);
  EXPECT_EQ(entered.entry.error, 0);
  EXPECT_EQ(entered.policy, SCHED_OTHER);
  EXPECT_EQ(entered.timer_slack_ns, 1);
}

// Root gets the priority; a container without CAP_SYS_NICE does not. Either way the kernel's own answer
// decides.
TEST(EnterThread, ThePriorityIsTakenWhereTheKernelGrantsIt) {
  const int error = kernels_answer(kPlan.priority);
  const test::CollectedLog log;
  const Entered entered = enter(kPlan, true);
  EXPECT_EQ(entered.name, "heel-control");
  EXPECT_EQ(entered.entry.realtime, error == 0);
  EXPECT_EQ(entered.entry.error, error);
  EXPECT_EQ(entered.policy, error == 0 ? SCHED_FIFO : SCHED_OTHER);
  EXPECT_EQ(entered.priority, error == 0 ? kPlan.priority : 0);
  EXPECT_EQ(log.count("heel-control: real-time priority 60 refused"), error == 0 ? 0 : 1) << log.text();
}

TEST(EnterThread, ARefusalNamesTheReasonAndTheRemedyAndTheThreadGoesOn) {
  const test::CollectedLog log;
  const NoPriorityLimit no_limit;
  const Entered entered = enter(kPlan, true, drop_sys_nice);
  EXPECT_FALSE(entered.entry.realtime);
  EXPECT_EQ(entered.entry.error, EPERM);
  EXPECT_EQ(entered.policy, SCHED_OTHER);
  EXPECT_EQ(entered.name, "heel-control");
  EXPECT_EQ(log.count("[warning] heel-control: real-time priority 60 refused (Operation not permitted)"), 1)
      << log.text();
  EXPECT_EQ(log.count("CAP_SYS_NICE"), 1) << log.text();
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
