// The link and the simulated P3-AT as two ends of real lines, in real time: pty and TCP, hang-up and return.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>

#include "loopback/robot/robot_thread.h"
#include "realtime/clock.h"
#include "robot/robot_link.h"

namespace heel {
namespace {

using test::pty_address;
using test::RobotThread;

class LinkBench {
 public:
  explicit LinkBench(const std::string& address) : link(config(address)) {}
  static RobotConfig config(const std::string& address) {
    RobotConfig config;
    config.address = address;
    config.reconnect_s = 0.2;
    config.sync_retry_s = 0.3;
    return config;
  }
  void tick() {
    const TimeNs now_ns = monotonic_now_ns();
    link.read(now_ns);
    link.write({now_ns, now_ns + 200 * kNsPerMs, v_m_s, 0.0, 0}, now_ns);
    longest_ns = std::max(longest_ns, monotonic_now_ns() - now_ns);
    link.listen_until(now_ns + 20 * kNsPerMs);
  }
  void run(double seconds) {
    for (const TimeNs end_ns = monotonic_now_ns() + ns_from_seconds(seconds); monotonic_now_ns() < end_ns;)
      tick();
  }
  bool run_until(LinkPhase phase, double seconds) {
    for (const TimeNs end_ns = monotonic_now_ns() + ns_from_seconds(seconds); monotonic_now_ns() < end_ns;) {
      tick();
      if (link.state().phase == phase) return true;
    }
    return false;
  }
  RobotLink link;
  double v_m_s = 0.0;
  TimeNs longest_ns = 0;
};

TEST(LinkOverPty, DrivesAndShutsDown) {
  const std::string address = pty_address("drive");
  RobotThread robot(address);
  LinkBench bench(address);
  ASSERT_TRUE(bench.run_until(LinkPhase::Running, 10.0));
  bench.v_m_s = 0.3;
  bench.run(1.5);
  EXPECT_NEAR(robot.truth().v_m_s, 0.3, 0.05);
  EXPECT_GT(bench.link.state().odometry.x_m, 0.2);
  EXPECT_EQ(bench.link.state().checksum_errors, 0u);

  const TimeNs begin_ns = monotonic_now_ns();
  bench.link.shutdown(begin_ns);
  EXPECT_LT(monotonic_now_ns() - begin_ns, 400 * kNsPerMs);
  EXPECT_GT(monotonic_now_ns() - begin_ns, 20 * kNsPerMs) << "closed over an adapter's head";
  sleep_until_ns(monotonic_now_ns() + kNsPerS);
  EXPECT_EQ(robot.truth().session, sim::Session::Waiting);
  EXPECT_NEAR(robot.truth().v_m_s, 0.0, 1e-3);
  EXPECT_EQ(bench.link.state().phase, LinkPhase::Closed);
}

TEST(LinkOverPty, FindsTheRateOfARobotAsItComesAndRaisesIt) {
  const std::string address = pty_address("rate");
  RobotThread robot(address, 9600);
  LinkBench bench(address + "@57600");
  ASSERT_TRUE(bench.run_until(LinkPhase::Running, 15.0));
  EXPECT_EQ(robot.truth().baud, 57600);
  bench.v_m_s = 0.3;
  bench.run(1.5);
  EXPECT_NEAR(robot.truth().v_m_s, 0.3, 0.05);
}

TEST(LinkOverPty, SipsAreStampedAsTheyComeNotAtTheTick) {
  const std::string address = pty_address("stamp");
  RobotThread robot(address);
  LinkBench bench(address);
  ASSERT_TRUE(bench.run_until(LinkPhase::Running, 10.0));
  // One long wait in place of many ticks: what came meanwhile bears the times at which it came.
  int before_the_deadline = 0;  // on a busy machine not each time
  for (int i = 0; i < 5; ++i) {
    const TimeNs begin_ns = monotonic_now_ns();
    const TimeNs deadline_ns = begin_ns + 300 * kNsPerMs;
    const std::uint64_t sips = bench.link.state().sips;
    bench.link.listen_until(deadline_ns);
    EXPECT_GE(monotonic_now_ns(), deadline_ns);
    EXPECT_GT(bench.link.state().sips, sips);
    EXPECT_GT(bench.link.state().odometry.t_ns, begin_ns);
    before_the_deadline += bench.link.state().odometry.t_ns < deadline_ns;
  }
  EXPECT_GT(before_the_deadline, 0);
}

TEST(LinkOverPty, HungUpAndBack) {
  const std::string address = pty_address("hangup");
  auto robot = std::make_unique<RobotThread>(address);
  LinkBench bench(address);
  ASSERT_TRUE(bench.run_until(LinkPhase::Running, 10.0));
  robot.reset();
  ASSERT_TRUE(bench.run_until(LinkPhase::Lost, 1.0));
  bench.run(0.5);
  EXPECT_GT(bench.link.open_failures(), 0u);
  EXPECT_NE(bench.link.last_open_error().find("No such file"), std::string::npos);
  robot = std::make_unique<RobotThread>(address);
  EXPECT_TRUE(bench.run_until(LinkPhase::Running, 10.0));
  EXPECT_EQ(bench.link.state().reconnects, 1u);
}

TEST(LinkOverPty, ADestroyedLinkLeavesTheRobotClosed) {
  const std::string address = pty_address("destroyed");
  RobotThread robot(address);
  {
    LinkBench bench(address);
    ASSERT_TRUE(bench.run_until(LinkPhase::Running, 10.0));
    bench.v_m_s = 0.3;
    bench.run(0.5);
  }
  sleep_until_ns(monotonic_now_ns() + kNsPerS);
  EXPECT_EQ(robot.truth().session, sim::Session::Waiting);
  EXPECT_NEAR(robot.truth().v_m_s, 0.0, 1e-3);
}

TEST(LinkOverTcp, Drives) {
  RobotThread robot("tcp:127.0.0.1:0");
  LinkBench bench(robot.address());
  ASSERT_TRUE(bench.run_until(LinkPhase::Running, 10.0));
  bench.v_m_s = 0.3;
  bench.run(1.5);
  EXPECT_NEAR(robot.truth().v_m_s, 0.3, 0.05);
}

TEST(LinkWithoutARobot, NeitherBlocksNorEnds) {
  // A busy machine may hold up one of the runs; a link that blocks holds up every one.
  TimeNs longest_ns = kNsPerS;
  for (int i = 0; i < 5 && longest_ns >= 50 * kNsPerMs; ++i) {
    LinkBench bench("pty:/nonexistent/robot");
    bench.run(0.5);
    EXPECT_EQ(bench.link.state().phase, LinkPhase::Closed);
    EXPECT_GT(bench.link.open_failures(), 0u);
    longest_ns = std::min(longest_ns, bench.longest_ns);
  }
  EXPECT_LT(longest_ns, 50 * kNsPerMs);
}

}  // namespace
}  // namespace heel
