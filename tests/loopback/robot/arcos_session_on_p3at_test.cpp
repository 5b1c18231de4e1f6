// The session with the simulated P3-AT in lock step and virtual time: rates of the line, speeds, units.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "loopback/robot/p3at_bench.h"
#include "robot/arcos_session.h"
#include "sim/robot/p3at.h"

namespace heel {
namespace {

using sim::FaultKind;
using test::exact_robot;
using test::kTick_ns;
using test::P3AtBench;
using Kind = SessionEventKind;

TEST(ArcosSessionOnP3At, ConnectsAtEveryRateTheRobotMayHave) {
  for (const int baud : kRobotBauds) {
    sim::P3AtSettings settings = exact_robot();
    settings.boot_baud = baud;
    P3AtBench bench(settings);
    bench.start();
    EXPECT_TRUE(bench.run_until(LinkPhase::Running, 15.0)) << baud;
    EXPECT_EQ(bench.count(Kind::ConfigReceived), 1) << baud;
    EXPECT_EQ(bench.session.identity().subclass.view(), "p3at-sh");
  }
}

TEST(ArcosSessionOnP3At, MeanSpeedsAreTheCommandedOnesAt9600Baud) {
  P3AtBench bench;
  bench.start();
  ASSERT_TRUE(bench.run_until(LinkPhase::Running, 5.0));
  bench.v_m_s = 0.2503;
  bench.yaw_rate_rad_s = 0.1234;  // 7.07 deg/s: between two units
  bench.run(2.0);
  const double heading_before = bench.robot.true_pose().heading_rad;
  double path_m = 0.0;
  auto last = bench.robot.true_pose();
  for (int i = 0; i < 1000; ++i) {
    bench.tick();
    const auto now = bench.robot.true_pose();
    path_m += std::hypot(now.x_m - last.x_m, now.y_m - last.y_m);
    last = now;
  }
  EXPECT_NEAR(path_m / 20.0, 0.2503, 0.0005);
  EXPECT_NEAR((last.heading_rad - heading_before) / 20.0, 0.1234, 0.0005);
  bench.v_m_s = bench.yaw_rate_rad_s = 0.0;
  bench.run(2.0);
  bench.expect_odometry_is_truth(0.05);
  EXPECT_EQ(bench.session.state().checksum_errors, 0u);
  EXPECT_LT(bench.robot.input_backlog(), 30u);  // commands do not accumulate on the line
}

TEST(ArcosSessionOnP3At, TheRateOfASlowLineIsRaisedBeforeTheMotorsRun) {
  for (const int wished : {19200, 38400, 57600, 115200}) {
    P3AtBench bench(exact_robot(), ("pty:robot@" + std::to_string(wished)).c_str());
    bench.start();
    for (int i = 0; i < 1000 && bench.robot.baud() == 9600; ++i) {
      bench.tick();
      ASSERT_FALSE(bench.robot.truth().motors_enabled);
    }
    ASSERT_TRUE(bench.run_until(LinkPhase::Running, 1.0)) << wished;
    EXPECT_EQ(bench.robot.baud(), wished);
    EXPECT_EQ(bench.session.wanted_baud(), wished);

    // CLOSE has set the robot's port back: the next session finds it there and raises it again.
    bench.robot.receive(bench.session.close(bench.now_ns), bench.now_ns);
    bench.run(0.1);
    EXPECT_EQ(bench.robot.baud(), 9600);
    bench.session = ArcosSession(bench.config);
    bench.start();
    EXPECT_TRUE(bench.run_until(LinkPhase::Running, 2.5)) << wished;
    EXPECT_EQ(bench.count(Kind::RateRaised), 2);
    EXPECT_EQ(bench.count(Kind::NoAnswer), 0);
  }
}

TEST(ArcosSessionOnP3At, ARobotThatKeepsItsRateAfterCloseIsFoundThere) {
  sim::P3AtSettings settings = exact_robot();
  settings.keeps_rate_after_close = true;
  P3AtBench bench(settings, "pty:robot@57600");
  bench.start();
  ASSERT_TRUE(bench.run_until(LinkPhase::Running, 5.0));
  bench.robot.receive(bench.session.close(bench.now_ns), bench.now_ns);
  bench.run(0.1);
  EXPECT_EQ(bench.robot.baud(), 57600);
  bench.session = ArcosSession(bench.config);
  bench.start();
  EXPECT_TRUE(bench.run_until(LinkPhase::Running, 2.0));
  EXPECT_EQ(bench.count(Kind::RateRaised), 1);
}

TEST(ArcosSessionOnP3At, TheRateOfALossyLineIsRaisedOrTheRobotStaysReachable) {
  for (int seed = 0; seed < 20; ++seed) {
    P3AtBench bench(exact_robot(), "pty:robot");
    bench.inject(FaultKind::GarbleBytes, 0.0, 0.01);
    bench.run(0.02 * seed);
    bench.start();
    EXPECT_TRUE(bench.run_until(LinkPhase::Running, 60.0)) << seed;
    EXPECT_EQ(bench.robot.baud(), bench.session.wanted_baud());
  }
}

TEST(ArcosSessionOnP3At, ANewCommandDoesNotWaitBehindOldOnes) {
  for (const int baud : kRobotBauds) {
    sim::P3AtSettings settings = exact_robot();
    settings.boot_baud = baud;
    P3AtBench bench(settings, ("pty:robot@" + std::to_string(baud)).c_str());
    bench.start();
    ASSERT_TRUE(bench.run_until(LinkPhase::Running, 5.0));
    bench.run(5.0);
    const double byte_ms = 10e3 / baud;
    for (int i = 0; i < 10; ++i) {
      bench.v_m_s = 0.0;
      bench.run(1.0 + 0.02 * i);
      bench.v_m_s = 0.4;
      const TimeNs t_asked_ns = bench.now_ns + kTick_ns;
      bench.tick();
      TimeNs t_ns = t_asked_ns;
      for (; bench.robot.truth().v_m_s == 0.0 && t_ns < t_asked_ns + kNsPerS; t_ns += kNsPerMs) {
        if (t_ns > t_asked_ns && (t_ns - t_asked_ns) % kTick_ns == 0) bench.tick();
        bench.robot.advance(t_ns + kNsPerMs);
      }
      // Its own 9 bytes and RVEL's before it, or at 9600 baud the tick in which RVEL is sent; and two steps
      // of the model.
      const double turn_ms = baud == 9600 ? 20.0 : 9 * byte_ms;
      EXPECT_LE(static_cast<double>(t_ns - t_asked_ns) / kNsPerMs, 9 * byte_ms + turn_ms + 2.0) << baud;
    }
  }
}

TEST(ArcosSessionOnP3At, AnOlderModelWithOtherUnitsIsMeasuredRight) {
  sim::P3AtSettings settings = sim::settings_of_model("p3at");
  settings.chassis = exact_robot().chassis;
  P3AtBench bench(settings);
  bench.start();
  ASSERT_TRUE(bench.run_until(LinkPhase::Running, 5.0));
  bench.v_m_s = 0.5;
  bench.run(40.0);  // 20 m: its counters wrap each 15 m
  bench.v_m_s = 0.0;
  bench.run(2.0);
  EXPECT_GT(bench.session.state().odometry.x_m, 15.0);
  bench.expect_odometry_is_truth(0.05);
}

}  // namespace
}  // namespace heel
