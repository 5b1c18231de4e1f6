// Faults of the simulated P3-AT and its line, and what the session makes of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "loopback/robot/p3at_bench.h"
#include "robot/arcos_session.h"
#include "sim/robot/p3at.h"

namespace heel {
namespace {

using sim::FaultKind;
using test::P3AtBench;
using Kind = SessionEventKind;

TEST(ArcosSessionFaults, ARobotLeftOpenAndMovingIsStoppedAndDoesNotJump) {
  P3AtBench bench;
  bench.inject(FaultKind::LeftOpen, 0.0, 400.0);
  bench.run(0.1);
  const auto before = bench.robot.true_pose();
  bench.start();
  ASSERT_TRUE(bench.run_until(LinkPhase::Running, 10.0));
  EXPECT_GE(bench.count(Kind::FoundOpen), 1);
  bench.run(2.0);
  const auto after = bench.robot.true_pose();
  // The robot does not move again before the first command.
  EXPECT_LT(std::hypot(after.x_m - before.x_m, after.y_m - before.y_m), 0.20);
  EXPECT_NEAR(bench.robot.truth().v_m_s, 0.0, 1e-6);
}

TEST(ArcosSessionFaults, KilledWhileDrivingTheRobotStopsByTheWatchdogAndDoesNotResume) {
  P3AtBench bench;
  bench.start();
  ASSERT_TRUE(bench.run_until(LinkPhase::Running, 5.0));
  bench.v_m_s = 0.5;
  bench.run(3.0);
  ASSERT_GT(bench.robot.truth().v_m_s, 0.45);
  bench.running = false;  // kill -9
  bench.run(2.0 + 0.5);   // the watchdog, and the time to brake at 1.5 m/s²
  ASSERT_NEAR(bench.robot.truth().v_m_s, 0.0, 1e-6);
  const auto stood = bench.robot.true_pose();

  bench.session = ArcosSession(bench.config);
  bench.v_m_s = 0.0;
  bench.start();
  for (const TimeNs end_ns = bench.now_ns + 5 * kNsPerS; bench.now_ns < end_ns;) {
    bench.tick();
    ASSERT_NEAR(bench.robot.true_pose().x_m, stood.x_m, 1e-6) << "the robot moved again";
  }
  EXPECT_EQ(bench.session.state().phase, LinkPhase::Running);
}

TEST(ArcosSessionFaults, FollowsOverALossyLine) {
  for (const auto kind : {FaultKind::DropBytes, FaultKind::GarbleBytes}) {
    P3AtBench bench;
    bench.inject(kind, 0.0, 0.005);
    bench.start();
    ASSERT_TRUE(bench.run_until(LinkPhase::Running, 30.0));
    bench.v_m_s = 0.3;
    TimeNs oldest_ns = 0;
    for (int i = 0; i < 3000; ++i) {
      bench.tick();
      oldest_ns = std::max(oldest_ns, bench.now_ns - bench.session.state().odometry.t_ns);
    }
    EXPECT_EQ(bench.session.state().phase, LinkPhase::Running);
    EXPECT_GT(bench.session.state().checksum_errors, 20u);
    EXPECT_GT(bench.session.state().sips, 350u);
    EXPECT_EQ(bench.count(Kind::SipSilence), 0);
    EXPECT_LT(oldest_ns, kNsPerS);
    bench.expect_odometry_is_truth(0.4);  // the pose is as old as the last SIP
  }
}

TEST(ArcosSessionFaults, AfterASilenceThePoseIsTheSame) {
  P3AtBench bench;
  bench.start();
  ASSERT_TRUE(bench.run_until(LinkPhase::Running, 5.0));
  bench.v_m_s = 0.4;
  bench.run(5.0);
  bench.v_m_s = 0.0;
  bench.inject(FaultKind::Silence, 4.0);
  ASSERT_TRUE(bench.run_until(LinkPhase::Lost, 3.0));
  ASSERT_TRUE(bench.run_until(LinkPhase::Running, 10.0));
  EXPECT_EQ(bench.session.state().reconnects, 1u);
  bench.run(1.0);
  bench.expect_odometry_is_truth(0.02);
}

TEST(ArcosSessionFaults, ControllerResetWhileDriving) {
  P3AtBench bench;
  bench.start();
  ASSERT_TRUE(bench.run_until(LinkPhase::Running, 5.0));
  bench.v_m_s = 0.4;
  bench.run(5.0);
  bench.inject(FaultKind::Reset, 0.0, 255.0);
  bench.v_m_s = 0.0;
  ASSERT_TRUE(bench.run_until(LinkPhase::Syncing, 0.5));
  EXPECT_EQ(bench.count(Kind::ControllerReset), 1);
  ASSERT_TRUE(bench.run_until(LinkPhase::Running, 20.0));
  EXPECT_EQ(bench.count(Kind::OdometryRebased), 1);
  bench.run(1.0);
  // How far it rolled while its counters were set to zero cannot be known.
  bench.expect_odometry_is_truth(0.2);
}

TEST(ArcosSessionFaults, StopButtonKeepsTheMotorsOffUntilANewSession) {
  P3AtBench bench;
  bench.start();
  ASSERT_TRUE(bench.run_until(LinkPhase::Running, 5.0));
  bench.v_m_s = 0.4;
  bench.run(2.0);
  bench.robot.press_stop_button(true);
  ASSERT_TRUE(bench.run_until(LinkPhase::Disabled, 0.3));
  bench.run(1.0);
  bench.robot.press_stop_button(false);
  const auto stood = bench.robot.true_pose();
  bench.run(5.0);
  EXPECT_EQ(bench.session.state().phase, LinkPhase::Disabled);
  EXPECT_EQ(bench.robot.true_pose().x_m, stood.x_m);
  bench.robot.receive(bench.session.close(bench.now_ns), bench.now_ns);
  bench.session = ArcosSession(bench.config);
  bench.start();
  ASSERT_TRUE(bench.run_until(LinkPhase::Running, 5.0));
  bench.run(2.0);
  EXPECT_GT(bench.robot.truth().v_m_s, 0.35);
}

TEST(ArcosSessionFaults, ConnectsWithoutAConfigWhoseChecksumIsAlwaysWrong) {
  P3AtBench bench;
  bench.inject(FaultKind::BadConfig);
  bench.start();
  EXPECT_TRUE(bench.run_until(LinkPhase::Running, 5.0));
  EXPECT_EQ(bench.count(Kind::ConfigMissing), 1);
}

TEST(ArcosSessionFaults, BumpersAndStallsAreReported) {
  P3AtBench bench;
  bench.start();
  ASSERT_TRUE(bench.run_until(LinkPhase::Running, 5.0));
  bench.robot.touch_bumper(0b0000100, 0b0010000);
  bench.run(0.3);
  EXPECT_EQ(bench.session.state().bumpers_front, 0b0000100);
  EXPECT_EQ(bench.session.state().bumpers_rear, 0b0010000);
  bench.robot.touch_bumper(0, 0);
  bench.robot.block_wheels(true, false);
  bench.v_m_s = 0.3;
  bool stalled = false;
  for (int i = 0; i < 200; ++i) {
    bench.tick();
    stalled = stalled || (bench.session.state().stall_left && !bench.session.state().stall_right);
  }
  EXPECT_TRUE(stalled);
}

TEST(ArcosSessionFaults, CloseLeavesItClosedAndAtRest) {
  P3AtBench bench;
  bench.start();
  ASSERT_TRUE(bench.run_until(LinkPhase::Running, 5.0));
  bench.v_m_s = 0.4;
  bench.run(2.0);
  bench.robot.receive(bench.session.close(bench.now_ns), bench.now_ns);
  bench.run(1.0);
  EXPECT_EQ(bench.robot.truth().session, sim::Session::Waiting);
  EXPECT_NEAR(bench.robot.truth().v_m_s, 0.0, 1e-6);
  EXPECT_FALSE(bench.robot.truth().motors_enabled);
}

}  // namespace
}  // namespace heel
