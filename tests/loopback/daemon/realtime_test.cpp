// The running heeld against its table of threads, as /proc shows it, and with a library before it that ends
// it at the first allocation, lock or formatted text in a hot thread.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>

#include <csignal>
#include <filesystem>
#include <map>
#include <set>
#include <string>

#include "evaluation/metrics/process_figures.h"
#include "loopback/daemon/live_heeld.h"
#include "realtime/schedule.h"
#include "support/priorities.h"
#include "support/sanitized.h"

namespace heel {
namespace {

using evaluation::memory_of;
using evaluation::ThreadFigures;
using evaluation::threads_of;
using test::read_text;

using ::testing::HasSubstr;

using RealTimeHeeld = test::LiveHeeld;

Config as_configured() {
  Config config;
  config.runtime.core_vision = 0;
  return config;
}

/// By name; heeld has no two threads of one name.
std::map<std::string, ThreadFigures> by_name(const std::vector<ThreadFigures>& threads) {
  std::map<std::string, ThreadFigures> named;
  for (const ThreadFigures& thread : threads)
    EXPECT_TRUE(named.emplace(thread.name, thread).second) << "two threads are called " << thread.name;
  return named;
}

void expect_row(const ThreadPlan& plan, const ThreadFigures& thread) {
  EXPECT_EQ(thread.policy, plan.priority > 0 ? SCHED_FIFO : SCHED_OTHER) << plan.name;
  EXPECT_EQ(thread.priority, plan.priority) << plan.name;
  if (plan.core < 0) return;
  EXPECT_EQ(CPU_COUNT(&thread.cores), 1) << plan.name;
  EXPECT_TRUE(CPU_ISSET(static_cast<unsigned>(plan.core), &thread.cores)) << plan.name;
}

TEST_F(RealTimeHeeld, KeepsToItsTableOfThreads) {
  if (test::kThreadSanitizer)
    GTEST_SKIP() << "this sanitizer has a thread of its own, and makes vision too slow";
  if (test::answer_to_fifo_request(1) != 0) GTEST_SKIP() << "real-time priorities are not granted here";
  start_following(
      live_config(true, "core_vision = 0\n",
                  "[view]\naddress = \"127.0.0.1:0\"\n[mqtt]\naddress = \"tcp://127.0.0.1:1\"\n"));
  const std::map<std::string, ThreadFigures> before = by_name(threads_of(daemon_->pid()));
  test::sleep_s(2.0);
  const std::map<std::string, ThreadFigures> after = by_name(threads_of(daemon_->pid()));
  ASSERT_GT(speed(), 0.2) << "it follows all the time" << logs();

  std::size_t rows = 0, hot = 0;
  for (const ThreadPlan& plan : make_schedule(as_configured())) {
    ASSERT_TRUE(before.contains(plan.name) && after.contains(plan.name))
        << "no thread is called " << plan.name;
    const ThreadFigures &then = before.at(plan.name), &now = after.at(plan.name);
    expect_row(plan, now);
    ++rows;
    if (!plan.hot) continue;
    ++hot;
    EXPECT_EQ(now.minor_faults - then.minor_faults, 0u) << plan.name;
    EXPECT_EQ(now.major_faults - then.major_faults, 0u) << plan.name;
    EXPECT_GT(now.switches - then.switches, 30u) << plan.name << " waits for frames or ticks";
    RecordProperty(std::string(plan.name) + " forced switches",
                   static_cast<int>(now.forced_switches - then.forced_switches));
  }
  EXPECT_EQ(after.size(), rows) << "every thread has a row";
  EXPECT_EQ(hot, 3u);
}

TEST_F(RealTimeHeeld, IsSmallAndLockedAndLoadsNoLibraryThatItsCameraDoesNotNeed) {
  if (test::kSanitized) GTEST_SKIP() << "sanitizers map memory of their own";
  if (test::answer_to_fifo_request(1) != 0) GTEST_SKIP() << "locked memory is not granted here";
  start_following(live_config(true));
  const evaluation::MemoryFigures memory = memory_of(daemon_->pid());
  EXPECT_LT(memory.resident_mb, 80.0);
  EXPECT_GT(memory.locked_mb, 0.9 * memory.resident_mb);
  std::size_t heel = 0;
  for (const evaluation::MappingFigures& mapping : memory.mappings) {
    heel += mapping.name == "heeld" ? 1 : 0;
    for (const char* library : {"libav", "libopencv", "libcamera", "camera-"})
      EXPECT_FALSE(mapping.name.starts_with(library)) << mapping.name;
  }
  EXPECT_EQ(heel, 1u) << "the mappings are those of heeld";
}

TEST_F(RealTimeHeeld, ACoreThatDoesNotExistIsRefusedAndItRunsOnAny) {
  if (test::answer_to_fifo_request(1) != 0) GTEST_SKIP() << "real-time priorities are not granted here";
  start_following(live_config(true, "core_vision = 1000\n"));
  EXPECT_TRUE(
      daemon_->says("thread heel-vision: processor core 1000 refused (Invalid argument); it runs on any"))
      << logs();
}

TEST_F(RealTimeHeeld, ATickThatIsTooLateIsAFaultThatStopsTheRobot) {
  start_following(live_config(false));
  const double lateness_max_s = defaults_.supervisor.lateness_max_s;
  daemon_->signal(SIGSTOP);
  test::sleep_s(2.0 * lateness_max_s);
  daemon_->signal(SIGCONT);
  EXPECT_TRUE(daemon_->says("at rest: control too late")) << logs();
}

#ifdef HEEL_HAVE_HOT_TRAP

class TrappedHeeld : public RealTimeHeeld {
 protected:
  void start_trapped(std::map<std::string, std::string> environment = {}) {
    environment["LD_PRELOAD"] = test::built_program("libheel_hot_trap.so");
    environment["NOTIFY_SOCKET"] = notify_.path();
    daemon_ = std::make_unique<test::Process>(
        std::vector<std::string>{test::built_program("heeld"), "--config", live_config(false)},
        scene_.path("heeld.log"), environment);
  }
};

TEST_F(TrappedHeeld, HotThreadsNeitherAllocateNorLockNorFormatWhateverHappens) {
  start_robot();
  start_trapped();
  ASSERT_TRUE(starts_to_drive()) << logs();
  camera_.show_person(false);
  ASSERT_TRUE(daemon_->says("target lost")) << logs();
  ASSERT_TRUE(comes_to_rest()) << logs();
  camera_.show_person(true);
  ASSERT_TRUE(starts_to_drive()) << logs();
  robot_.reset();                                 // the line breaks
  std::filesystem::remove(scene_.path("robot"));  // it leaves a link to a pty that another test may get
  ASSERT_TRUE(daemon_->says("at rest: no link to the robot")) << logs();
  start_robot();
  ASSERT_TRUE(starts_to_drive()) << logs();
  daemon_->signal(SIGTERM);
  EXPECT_EQ(daemon_->wait(), 0) << logs();
  EXPECT_THAT(daemon_->output(), Not(HasSubstr("hot trap"))) << logs();
}

TEST_F(TrappedHeeld, AnAllocationInAHotThreadEndsItWithTheThreadsNameAndABacktrace) {
  int ended = 0;
  for (const char* thread : {"heel-capture", "heel-vision", "heel-control"}) {
    start_robot();
    start_trapped({{"HEEL_TRAP_PLANT", thread}});
    EXPECT_EQ(daemon_->wait(), -SIGABRT) << logs();
    EXPECT_THAT(daemon_->output(), HasSubstr("hot trap: " + std::string(thread) + " calls malloc"));
    EXPECT_THAT(daemon_->output(), HasSubstr("heeld(+0x")) << "a backtrace through heeld";
    robot_.reset();
    ++ended;
  }
  EXPECT_EQ(ended, 3);
}

#endif  // HEEL_HAVE_HOT_TRAP

}  // namespace
}  // namespace heel
