// The session from the first byte until the motors are enabled, with robots in every state.
#include <gtest/gtest.h>

#include <string>
#include <string_view>

#include "robot/session_bench.h"

namespace heel {
namespace {

using arcos::CommandId;
using test::bench_config;
using test::Received;
using test::SessionBench;
using Kind = SessionEventKind;

TEST(ArcosSessionConnect, WholeScriptInOrder) {
  SessionBench bench;
  ASSERT_TRUE(bench.run_until(LinkPhase::Running));
  struct Expected {
    CommandId id;
    bool has_value;
    int value;
  };
  const RobotConfig c = bench_config();
  const Expected script[] = {
      {CommandId::Sync0, false, 0},
      {CommandId::Sync1, false, 0},
      {CommandId::Sync2, false, 0},
      {CommandId::Open, true, 1},
      {CommandId::Stop, false, 0},
      {CommandId::Config, true, 1},
      {CommandId::SetV, true, c.v_limit_mm_s},
      {CommandId::SetA, true, c.acceleration_mm_s2},
      {CommandId::SetA, true, -c.deceleration_mm_s2},
      {CommandId::SetRv, true, c.yaw_rate_limit_deg_s},
      {CommandId::SetRa, true, c.yaw_acceleration_deg_s2},
      {CommandId::SetRa, true, -c.yaw_acceleration_deg_s2},
      {CommandId::Sonar, true, 1},
      {CommandId::Vel, true, 0},
      {CommandId::RVel, true, 0},
      {CommandId::Enable, true, 1},
  };
  ASSERT_GE(bench.robot.log.size(), std::size(script));
  for (std::size_t i = 0; i < std::size(script); ++i) {
    const Received& got = bench.robot.log[i];
    EXPECT_TRUE(got.is(script[i].id)) << i << ": " << got.id;
    EXPECT_EQ(got.has_value, script[i].has_value) << i;
    EXPECT_EQ(got.value, script[i].value) << i;
  }
  EXPECT_EQ(bench.session.identity().subclass.view(), "p3at-sh");
  EXPECT_TRUE(bench.session.state().motors_enabled);
  EXPECT_EQ(bench.count(Kind::ConfigReceived), 1);
}

TEST(ArcosSessionConnect, PhasesInOrder) {
  SessionBench bench;
  EXPECT_EQ(bench.session.state().phase, LinkPhase::Syncing);
  EXPECT_TRUE(bench.run_until(LinkPhase::Opening));
  EXPECT_FALSE(bench.session.state().has_sip);
  bench.robot.enables_to_ignore = 1;
  EXPECT_TRUE(bench.run_until(LinkPhase::Enabling));
  EXPECT_TRUE(bench.session.state().has_sip);
  EXPECT_TRUE(bench.run_until(LinkPhase::Running));
}

TEST(ArcosSessionConnect, SendsNothingBeforeItHasListened) {
  SessionBench bench;
  bench.run(0.28);
  EXPECT_EQ(bench.robot.bytes_received, 0u);
}

TEST(ArcosSessionConnect, JunkBeforeTheFirstEcho) {
  SessionBench bench;
  bench.robot.junk = "WMS2\r";
  EXPECT_TRUE(bench.run_until(LinkPhase::Running));
  EXPECT_EQ(bench.session.state().bytes_discarded, 5u);
}

TEST(ArcosSessionConnect, RobotThatAnswersLate) {
  SessionBench bench;
  bench.robot.mute = true;
  bench.run(1.0);
  bench.robot.mute = false;
  EXPECT_TRUE(bench.run_until(LinkPhase::Running));
}

TEST(ArcosSessionConnect, LastEchoLost) {
  SessionBench bench;
  bench.robot.last_echoes_to_swallow = 1;
  EXPECT_TRUE(bench.run_until(LinkPhase::Running));
}

TEST(ArcosSessionConnect, ASessionLeftOpenIsStoppedAndClosedBeforeAnyPulse) {
  SessionBench bench;
  bench.robot.open = true;
  bench.robot.set_flag(arcos::kFlagMotorsEnabled, true);
  ASSERT_TRUE(bench.run_until(LinkPhase::Running));
  EXPECT_EQ(bench.count(Kind::FoundOpen), 1);
  ASSERT_GE(bench.robot.log.size(), 3u);
  EXPECT_TRUE(bench.robot.log[0].is(CommandId::Stop));   // zero first …
  EXPECT_TRUE(bench.robot.log[1].is(CommandId::Close));  // … and a closed robot does not take SYNC0 as PULSE
  EXPECT_TRUE(bench.robot.log[2].is(CommandId::Sync0));
}

TEST(ArcosSessionConnect, MotorsAlreadyOnAreDrivenOnlyAfterZeroHasBeenSent) {
  SessionBench bench;
  bench.robot.set_flag(arcos::kFlagMotorsEnabled, true);
  bench.v_m_s = 0.5;
  ASSERT_TRUE(bench.run_until(LinkPhase::Running));
  EXPECT_FALSE(bench.robot.received(CommandId::Enable).empty()) << "Running comes after ENABLE";
  bench.run(0.5);
  const auto speeds = bench.robot.received(CommandId::Vel);
  ASSERT_GT(speeds.size(), 3u);
  EXPECT_EQ(speeds[0].value, 0);
  EXPECT_LT(bench.robot.find(CommandId::Vel), bench.robot.find(CommandId::Enable));
  EXPECT_EQ(speeds.back().value, 500);
}

// At 9600 baud the zero and ENABLE do not fit into one tick, and a packet that says "on" arrives between
// them.
TEST(ArcosSessionConnect, MotorsAlreadyOnAreDrivenOnlyAfterZeroHasBeenSentOnASlowLine) {
  SessionBench bench(bench_config("serial:/dev/ttyUSB0@9600"));
  bench.robot.baud = 9600;
  bench.robot.sip_period_ns = test::kTick_ns;
  bench.robot.set_flag(arcos::kFlagMotorsEnabled, true);
  bench.v_m_s = 0.5;
  ASSERT_TRUE(bench.run_until(LinkPhase::Running));
  ASSERT_FALSE(bench.robot.received(CommandId::Vel).empty()) << "the zero is still waiting";
  EXPECT_EQ(bench.robot.received(CommandId::Vel)[0].value, 0);
  EXPECT_FALSE(bench.robot.received(CommandId::RVel).empty());
  EXPECT_FALSE(bench.robot.received(CommandId::Enable).empty());
}

TEST(ArcosSessionBaud, FindsTheRateTheRobotWasLeftAt) {
  for (const int baud : kRobotBauds) {
    SessionBench bench(bench_config("serial:/dev/ttyUSB0@38400"));
    bench.robot.baud = baud;
    EXPECT_EQ(bench.session.wanted_baud(), 38400);
    ASSERT_TRUE(bench.run_until(LinkPhase::Running, 30.0)) << baud;
    EXPECT_EQ(bench.session.wanted_baud(), baud);

    bench.session.line_lost(bench.now_ns);
    bench.session.line_opened(bench.now_ns);
    EXPECT_EQ(bench.session.wanted_baud(), baud);  // the last good one comes first
    ASSERT_TRUE(bench.run_until(LinkPhase::Running, 4.0)) << baud;
  }
}

TEST(ArcosSessionBaud, ASessionLeftOpenAtAnotherRateIsFoundAndClosed) {
  SessionBench bench(bench_config("serial:/dev/ttyUSB0@115200"));
  bench.robot.baud = 9600;
  bench.robot.open = true;
  ASSERT_TRUE(bench.run_until(LinkPhase::Running, 30.0));
  EXPECT_TRUE(bench.robot.log[0].is(CommandId::Stop));
}

TEST(ArcosSessionBaud, TheRateOfAnOpenSessionIsTheFirstToTryWhenTheLineIsLost) {
  SessionBench bench(bench_config("serial:/dev/ttyUSB0@115200"));
  bench.robot.baud = 9600;
  bench.robot.open = true;
  for (int i = 0; i < 1500 && bench.count(Kind::FoundOpen) == 0; ++i) bench.tick();
  ASSERT_EQ(bench.count(Kind::FoundOpen), 1);
  bench.session.line_lost(bench.now_ns);
  bench.session.line_opened(bench.now_ns);
  EXPECT_EQ(bench.session.wanted_baud(), 9600);
}

TEST(ArcosSessionBaud, ASweepWithoutAnswerAsksToOpenTheDeviceAgain) {
  SessionBench bench(bench_config("serial:/dev/ttyUSB0@38400"));
  bench.robot.mute = true;
  bench.run(2 * 0.5 + 5 * 2.0);
  EXPECT_FALSE(bench.session.line_exhausted());
  EXPECT_EQ(bench.count(Kind::NoAnswer), 0) << "a rate without an answer is no news while others are left";
  bench.run(2.5);
  EXPECT_TRUE(bench.session.line_exhausted());
  EXPECT_EQ(bench.count(Kind::NoAnswer), 1);
  bench.session.line_opened(bench.now_ns);
  EXPECT_FALSE(bench.session.line_exhausted());
}

TEST(ArcosSessionBaud, APtyIsSweptAsASerialLineIs) {
  SessionBench bench(bench_config("pty:/dev/pts/0"));
  bench.robot.baud = 9600;
  ASSERT_TRUE(bench.run_until(LinkPhase::Running, 30.0));
  EXPECT_EQ(bench.session.wanted_baud(), 9600);
}

TEST(ArcosSessionBaud, IsNotChangedOverTcp) {
  SessionBench bench(bench_config("tcp:robot:8101"));
  bench.robot.mute = true;
  const int baud = bench.session.wanted_baud();
  bench.run(3.0);
  EXPECT_EQ(bench.session.wanted_baud(), baud);
  EXPECT_TRUE(bench.session.line_exhausted());
  EXPECT_EQ(bench.count(Kind::NoAnswerTcp), 1);
  EXPECT_EQ(bench.count(Kind::NoAnswer), 0);
  EXPECT_EQ(bench.count(Kind::TryingBaud), 0);
}

TEST(ArcosSessionConfig, ConnectsAlsoWhenItIsMissingOrDamaged) {
  for (const bool damaged : {false, true}) {
    SessionBench bench;
    bench.robot.answers_config = damaged;
    bench.robot.config_damaged = damaged;
    ASSERT_TRUE(bench.run_until(LinkPhase::Running));
    EXPECT_EQ(bench.count(Kind::ConfigMissing), 1);
    EXPECT_FALSE(bench.session.state().limits.known);
    EXPECT_EQ(bench.session.state().limits.deceleration_m_s2, 0.3);
    EXPECT_EQ(bench.session.state().checksum_errors, damaged ? 1u : 0u);
    EXPECT_TRUE(
        bench.robot.log[bench.robot.find(CommandId::SetV)].is(CommandId::SetV, bench_config().v_limit_mm_s));
  }
}

TEST(ArcosSessionConfig, ControllersOwnLimitsAreNotExceeded) {
  SessionBench bench;
  bench.robot.config.trans_vel_top = 500;
  bench.robot.config.trans_acc_top = 1000;
  bench.robot.config.rot_vel_top = 90;
  bench.robot.config.rot_acc_top = 0;  // unknown
  ASSERT_TRUE(bench.run_until(LinkPhase::Running));
  const auto sent = [&](CommandId id, std::size_t i) { return bench.robot.received(id).at(i).value; };
  EXPECT_EQ(sent(CommandId::SetV, 0), 500);
  EXPECT_EQ(sent(CommandId::SetA, 0), bench_config().acceleration_mm_s2);
  EXPECT_EQ(sent(CommandId::SetA, 1), -1000);
  EXPECT_TRUE(bench.session.state().limits.known);
  EXPECT_EQ(bench.session.state().limits.deceleration_m_s2, 1.0);
  EXPECT_EQ(bench.session.state().limits.acceleration_m_s2, bench_config().acceleration_mm_s2 * 1e-3);
  EXPECT_EQ(bench.count(Kind::BrakesLimited), 1);
  EXPECT_EQ(sent(CommandId::SetRv, 0), 90);
  EXPECT_EQ(sent(CommandId::SetRa, 0), bench_config().yaw_acceleration_deg_s2);
}

TEST(ArcosSessionConfig, IsNotRequestedWhenTheConfigurationSaysSo) {
  RobotConfig config = bench_config();
  config.request_config = false;
  SessionBench bench(config);
  ASSERT_TRUE(bench.run_until(LinkPhase::Running));
  EXPECT_TRUE(bench.robot.received(CommandId::Config).empty());
  EXPECT_EQ(bench.count(Kind::ConfigMissing), 0);
}

TEST(ArcosSessionConfig, SonarsAreOnOrOffAsConfigured) {
  for (const bool on : {true, false}) {
    RobotConfig config = bench_config();
    config.sonar = on;
    SessionBench bench(config);
    ASSERT_TRUE(bench.run_until(LinkPhase::Running));
    EXPECT_EQ(bench.robot.received(CommandId::Sonar).at(0).value, on ? 1 : 0);
  }
}

TEST(ArcosSessionEnable, IsRepeatedUntilTheFlagConfirms) {
  SessionBench bench;
  bench.robot.enables_to_ignore = 2;
  ASSERT_TRUE(bench.run_until(LinkPhase::Running));
  const auto enables = bench.robot.received(CommandId::Enable);
  ASSERT_EQ(enables.size(), 3u);
  EXPECT_EQ(bench.count(Kind::EnableRepeated), 2);
}

TEST(ArcosSessionEnable, FailureIsReportedAndTheMotorsStayOff) {
  SessionBench bench;
  bench.robot.enables_to_ignore = 1000;
  bench.v_m_s = 0.5;
  ASSERT_TRUE(bench.run_until(LinkPhase::Disabled));
  EXPECT_EQ(bench.count(Kind::EnableFailed), 1);
  bench.run(5.0);
  EXPECT_EQ(bench.robot.received(CommandId::Enable).size(), 3u);
  for (const Received& speed : bench.robot.received(CommandId::Vel)) ASSERT_EQ(speed.value, 0);
}

TEST(ArcosSessionEnable, ButtonPressedFromTheBeginning) {
  SessionBench bench;
  bench.robot.set_flag(arcos::kFlagStopButton, true);
  ASSERT_TRUE(bench.run_until(LinkPhase::Disabled));
  EXPECT_EQ(bench.count(Kind::StopButton), 1);
}

}  // namespace
}  // namespace heel
