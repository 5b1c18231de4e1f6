// What a running session sends: a command each tick, in whole units with the right mean, no expired commands,
// no more than the line carries.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "robot/session_bench.h"

namespace heel {
namespace {

using arcos::CommandId;
using test::bench_config;
using test::kTick_ns;
using test::Received;
using test::RunningBench;
using test::SessionBench;

double mean(const std::vector<Received>& commands) {
  double sum = 0.0;
  for (const Received& command : commands) sum += command.value;
  return sum / static_cast<double>(commands.size());
}

TEST(ArcosSessionMotion, SendsVelAndRvelEachTickAlsoZero) {
  RunningBench bench;
  bench.run(2.0);
  EXPECT_EQ(bench.robot.received(CommandId::Vel).size(), 100u);
  EXPECT_EQ(bench.robot.received(CommandId::RVel).size(), 100u);
  EXPECT_EQ(bench.robot.log.size(), 200u);
}

TEST(ArcosSessionMotion, TheMeanIsTheCommandedVelocity) {
  RunningBench bench;
  bench.v_m_s = 0.2003;
  bench.yaw_rate_rad_s = -0.01;  // −0.573 deg/s: less than one unit
  bench.run(20.0);
  EXPECT_NEAR(mean(bench.robot.received(CommandId::Vel)), 200.3, 1e-3);
  EXPECT_NEAR(mean(bench.robot.received(CommandId::RVel)), -0.01 * 180.0 / M_PI, 1e-3);
  for (const Received& turn : bench.robot.received(CommandId::RVel)) {
    ASSERT_TRUE(turn.value == 0 || turn.value == -1);
  }
}

TEST(ArcosSessionMotion, FirstCommandAfterEnableIsZeroThenTheCommandedVelocity) {
  SessionBench bench;
  bench.v_m_s = 0.3;
  bench.yaw_rate_rad_s = 0.5;
  ASSERT_TRUE(bench.run_until(LinkPhase::Running));
  const std::size_t enabled = bench.robot.find(CommandId::Enable);
  bench.run(1.0);
  const std::size_t vel = bench.robot.find(CommandId::Vel, enabled);
  const std::size_t rvel = bench.robot.find(CommandId::RVel, enabled);
  EXPECT_TRUE(bench.robot.log.at(vel).is(CommandId::Vel, 0));
  EXPECT_TRUE(bench.robot.log.at(rvel).is(CommandId::RVel, 0));
  EXPECT_EQ(bench.robot.received(CommandId::Vel).back().value, 300);
}

TEST(ArcosSessionMotion, AnExpiredCommandCountsAsZero) {
  RunningBench bench;
  bench.v_m_s = 0.3;
  bench.yaw_rate_rad_s = 0.5;
  bench.command_lifetime_ns = 0;  // valid at its own nanosecond only
  bench.run(0.2);
  EXPECT_EQ(bench.robot.received(CommandId::Vel).back().value, 300);
  bench.robot.log.clear();
  bench.command_lifetime_ns = -1;
  bench.run(0.2);
  for (const Received& command : bench.robot.log) ASSERT_EQ(command.value, 0);
  EXPECT_EQ(bench.robot.log.size(), 20u);
}

TEST(ArcosSessionMotion, NotANumberCountsAsZeroAndLimitsHold) {
  RunningBench bench;
  bench.v_m_s = std::numeric_limits<double>::quiet_NaN();
  bench.yaw_rate_rad_s = std::numeric_limits<double>::infinity();
  bench.run(0.2);
  for (const Received& command : bench.robot.log) ASSERT_EQ(command.value, 0);
  bench.v_m_s = -1e9;
  bench.yaw_rate_rad_s = 1e9;
  bench.run(0.2);
  EXPECT_EQ(bench.robot.received(CommandId::Vel).back().value, -bench_config().v_limit_mm_s);
  EXPECT_EQ(bench.robot.received(CommandId::RVel).back().value, bench_config().yaw_rate_limit_deg_s);
}

TEST(ArcosSessionMotion, AfterAGapTheFirstCommandIsZero) {
  RunningBench bench;
  bench.v_m_s = 0.3;
  bench.run(0.5);
  bench.robot.log.clear();
  bench.now_ns += 300 * kNsPerMs;  // the control thread was delayed
  bench.run(0.1);
  const auto speeds = bench.robot.received(CommandId::Vel);
  EXPECT_EQ(speeds.at(0).value, 0);
  EXPECT_EQ(speeds.at(1).value, 300);

  bench.robot.log.clear();
  bench.now_ns += 200 * kNsPerMs;  // shorter: no gap
  bench.run(0.1);
  EXPECT_EQ(bench.robot.received(CommandId::Vel).at(0).value, 300);
}

TEST(ArcosSessionPacing, KeepsToItsShareOfTheLineAndToOneCommandEach4ms) {
  for (const int baud : kRobotBauds) {
    for (const TimeNs tick_ns : {5 * kNsPerMs, 10 * kNsPerMs, 20 * kNsPerMs}) {
      SessionBench bench(bench_config(("serial:/dev/ttyS0@" + std::to_string(baud)).c_str()));
      bench.v_m_s = 0.4;
      bench.yaw_rate_rad_s = 0.3;
      ASSERT_TRUE(bench.run_until(LinkPhase::Running));
      bench.robot.log.clear();
      const std::size_t bytes_before = bench.robot.bytes_received;
      for (int i = 0; i < 10 * kNsPerS / tick_ns; ++i) {
        bench.now_ns += tick_ns - kTick_ns;  // tick() adds kTick_ns
        bench.tick();
      }
      const auto bytes = static_cast<double>(bench.robot.bytes_received - bytes_before);
      EXPECT_LE(bytes, 0.60 * 10.0 * baud / 10.0 + 30.0) << baud;
      EXPECT_LE(bench.robot.log.size(), 10.0 / 0.004 + 4) << baud;
      const std::size_t vel = bench.robot.received(CommandId::Vel).size();
      const std::size_t rvel = bench.robot.received(CommandId::RVel).size();
      EXPECT_LE(vel, rvel + 1) << "VEL and RVEL alternate";
      EXPECT_LE(rvel, vel + 1);
      EXPECT_GE(vel, baud == 9600 ? 250u : 500u)
          << baud << " baud carry one of them (9600) or both each 20 ms";
    }
  }
}

TEST(ArcosSessionPacing, OverTcpTheRateOfTheRobotsSerialLineCounts) {
  for (const std::uint8_t code : {std::uint8_t{0}, std::uint8_t{2}}) {
    SessionBench bench(bench_config("tcp:robot:8101"));
    bench.robot.config.host_baud = code;
    ASSERT_TRUE(bench.run_until(LinkPhase::Running));
    bench.robot.log.clear();
    bench.run(2.0);
    EXPECT_EQ(bench.robot.log.size(), kRobotBauds[code] == 9600 ? 100u : 200u);
  }
}

TEST(ArcosSessionClose, SendsStopSonarOffAndCloseInThisOrderAndThenNothing) {
  RunningBench bench;
  const auto bytes = bench.session.close(bench.now_ns);
  EXPECT_EQ(std::vector<std::uint8_t>(bytes.begin(), bytes.end()),
            (std::vector<std::uint8_t>{0xfa, 0xfb, 3,    0x1d, 0,    0x1d, 0xfa, 0xfb, 6, 0x1c, 0x3b,
                                       0,    0,    0x1c, 0x3b, 0xfa, 0xfb, 3,    2,    0, 2}));
  EXPECT_EQ(bench.session.state().phase, LinkPhase::Closed);
  bench.run(3.0);
  EXPECT_TRUE(bench.robot.log.empty());
  EXPECT_TRUE(bench.session.close(bench.now_ns).empty());
}

TEST(ArcosSessionClose, FromEveryPhaseButNotWithoutALine) {
  for (double seconds = 0.0; seconds < 2.0; seconds += 0.02) {
    SessionBench bench;
    bench.run(seconds);
    EXPECT_EQ(bench.session.close(bench.now_ns).size(), 21u) << seconds;
  }
  SessionBench lost;
  lost.session.line_lost(lost.now_ns);
  EXPECT_TRUE(lost.session.close(lost.now_ns).empty());
}

TEST(ArcosSessionState, SipFieldsInSi) {
  RunningBench bench;
  bench.robot.sip.left_mm_s = 250;
  bench.robot.sip.right_mm_s = 350;
  bench.robot.sip.stall_and_bumpers = arcos::stall_and_bumpers_word(true, false, 0b0000100, 0b1000000);
  bench.robot.sip.battery_dv = 121;
  bench.run(0.2);
  const RobotState& state = bench.session.state();
  EXPECT_DOUBLE_EQ(state.odometry.v_m_s, 0.3);
  EXPECT_NEAR(state.odometry.yaw_rate_rad_s, 0.1 / 0.588, 1e-12);
  EXPECT_TRUE(state.stall_left);
  EXPECT_FALSE(state.stall_right);
  EXPECT_EQ(state.bumpers_front, 0b0000100);
  EXPECT_EQ(state.bumpers_rear, 0b1000000);
  EXPECT_DOUBLE_EQ(state.battery_v, 12.1);
  bench.robot.sip.gripper = bench.robot.sip.ad_port = bench.robot.sip.analog = 0;
  bench.robot.sip.digital_in = bench.robot.sip.digital_out = 0;
  bench.robot.sip.battery_long_dv = 263;
  bench.run(0.2);
  EXPECT_DOUBLE_EQ(state.battery_v, 26.3);
}

TEST(ArcosSessionState, EachSonarKeepsItsLastEchoAndItsTime) {
  RunningBench bench;
  const RobotState& state = bench.session.state();
  EXPECT_EQ(state.sonar[3].t_ns, 0) << "no echo yet";
  bench.robot.sip.sonar_count = 3;
  bench.robot.sip.sonars[0] = {3, 1234};
  bench.robot.sip.sonars[1] = {15, 5000};
  bench.robot.sip.sonars[2] = {16, 700};  // there is no seventeenth sonar
  bench.run(0.2);
  EXPECT_DOUBLE_EQ(state.sonar[3].range_m, 1.234);
  EXPECT_DOUBLE_EQ(state.sonar[15].range_m, 5.0);
  EXPECT_EQ(state.sonar[3].t_ns, state.odometry.t_ns);
  const TimeNs heard_ns = state.sonar[3].t_ns;
  bench.robot.sip.sonar_count = 1;
  bench.robot.sip.sonars[0] = {15, 600};
  bench.run(0.2);
  EXPECT_EQ(state.sonar[3].t_ns, heard_ns);
  EXPECT_DOUBLE_EQ(state.sonar[3].range_m, 1.234);
  EXPECT_DOUBLE_EQ(state.sonar[15].range_m, 0.6);
  EXPECT_GT(state.sonar[15].t_ns, heard_ns);
  EXPECT_EQ(state.sonar[0].t_ns, 0);
}

}  // namespace
}  // namespace heel
