// What a session does when the motors go off, and when an operator's reset enables them again.
#include <gtest/gtest.h>

#include "robot/session_bench.h"

namespace heel {
namespace {

using arcos::CommandId;
using test::Received;
using test::RunningBench;
using Kind = SessionEventKind;

TEST(ArcosSessionDisabled, StopButtonAndEStallKeepTheMotorsOffUntilANewSession) {
  for (const auto flag : {arcos::kFlagStopButton, arcos::kFlagEStall}) {
    RunningBench bench;
    bench.v_m_s = 0.3;
    bench.run(0.5);
    bench.robot.set_flag(flag, true);
    bench.robot.set_flag(arcos::kFlagMotorsEnabled, false);
    bench.run(0.2);
    EXPECT_EQ(bench.session.state().phase, LinkPhase::Disabled);
    EXPECT_EQ(bench.count(Kind::StopButton), 1);

    bench.robot.log.clear();
    bench.robot.set_flag(flag, false);
    bench.run(5.0);
    EXPECT_EQ(bench.session.state().phase,
              LinkPhase::Disabled);  // releasing the button does not start the motors
    EXPECT_TRUE(bench.robot.received(CommandId::Enable).empty());
    EXPECT_EQ(bench.robot.received(CommandId::Vel).size(), 250u);                 // the watchdog is fed …
    for (const Received& command : bench.robot.log) ASSERT_EQ(command.value, 0);  // … with zero

    bench.robot.log.clear();
    bench.restart();
    ASSERT_TRUE(bench.run_until(LinkPhase::Running));
    bench.run(0.2);
    const std::size_t enable = bench.robot.find(CommandId::Enable);
    ASSERT_GE(enable, 2u);
    EXPECT_TRUE(bench.robot.log[enable - 2].is(CommandId::Vel, 0));
    EXPECT_TRUE(bench.robot.log[enable - 1].is(CommandId::RVel, 0));
    EXPECT_TRUE(bench.robot.log[enable].is(CommandId::Enable, 1));
    EXPECT_EQ(bench.robot.received(CommandId::Vel).back().value, 300);
  }
}

TEST(ArcosSessionDisabled, MotorsSwitchedOnAtTheRobotAreNotDriven) {
  RunningBench bench;
  bench.robot.set_flag(arcos::kFlagMotorsEnabled, false);
  bench.run(0.3);
  EXPECT_EQ(bench.session.state().phase, LinkPhase::Disabled);
  EXPECT_EQ(bench.count(Kind::MotorsOff), 1);
  bench.robot.set_flag(arcos::kFlagMotorsEnabled, true);
  bench.v_m_s = 0.3;
  bench.robot.log.clear();
  bench.run(1.0);
  EXPECT_EQ(bench.session.state().phase, LinkPhase::Disabled);
  for (const Received& command : bench.robot.log) ASSERT_EQ(command.value, 0);
}

TEST(ArcosSessionDisabled, AReconnectionDoesNotEnableTheMotors) {
  RunningBench bench;
  bench.robot.set_flag(arcos::kFlagStopButton, true);
  bench.run(0.3);
  bench.robot.set_flag(arcos::kFlagStopButton, false);
  bench.robot.set_flag(arcos::kFlagMotorsEnabled, false);
  bench.session.line_lost(bench.now_ns);
  bench.session.line_opened(bench.now_ns);
  bench.robot.log.clear();
  ASSERT_TRUE(bench.run_until(LinkPhase::Disabled));
  bench.run(2.0);
  EXPECT_TRUE(bench.robot.received(CommandId::Enable).empty());
  bench.restart();
  EXPECT_TRUE(bench.run_until(LinkPhase::Running));
}

/// Drives after `session.enable_motors_again()`, with zero velocity before ENABLE.
void expect_enabled_again(RunningBench& bench) {
  bench.robot.log.clear();
  bench.session.enable_motors_again(bench.now_ns);
  EXPECT_EQ(bench.session.state().phase, LinkPhase::Enabling) << "at once: the next tick decides on it";
  ASSERT_TRUE(bench.run_until(LinkPhase::Running, 1.0));
  bench.run(0.2);
  const std::size_t enable = bench.robot.find(CommandId::Enable);
  ASSERT_GE(enable, 2u);
  EXPECT_TRUE(bench.robot.log[enable - 2].is(CommandId::Vel, 0));
  EXPECT_TRUE(bench.robot.log[enable - 1].is(CommandId::RVel, 0));
  EXPECT_EQ(bench.robot.received(CommandId::Vel).back().value, 300);
}

TEST(ArcosSessionReset, EnablesTheMotorsAgainAfterTheButtonIsReleased) {
  RunningBench bench;
  bench.v_m_s = 0.3;
  bench.robot.set_flag(arcos::kFlagStopButton, true);
  bench.robot.set_flag(arcos::kFlagMotorsEnabled, false);
  bench.run(0.3);
  bench.session.enable_motors_again(bench.now_ns);
  ASSERT_TRUE(bench.run_until(LinkPhase::Disabled, 0.5)) << "the button is still pressed";
  bench.robot.set_flag(arcos::kFlagStopButton, false);
  bench.run(1.0);
  EXPECT_EQ(bench.session.state().phase, LinkPhase::Disabled);
  expect_enabled_again(bench);
}

TEST(ArcosSessionReset, EndsAnEStall) {
  RunningBench bench;
  bench.v_m_s = 0.3;
  bench.robot.set_flag(arcos::kFlagEStall, true);
  bench.robot.set_flag(arcos::kFlagMotorsEnabled, false);
  bench.run(1.0);
  bench.robot.enable_ends_e_stall = true;
  expect_enabled_again(bench);
  bench.robot.set_flag(arcos::kFlagEStall, true);
  bench.run(0.2);
  EXPECT_EQ(bench.session.state().phase, LinkPhase::Disabled) << "a new one stops the motors again";
}

TEST(ArcosSessionReset, AnEStallThatEnableDoesNotEndKeepsTheMotorsOff) {
  RunningBench bench;
  bench.v_m_s = 0.3;
  bench.robot.set_flag(arcos::kFlagEStall, true);
  bench.robot.set_flag(arcos::kFlagMotorsEnabled, false);
  bench.run(1.0);
  bench.session.enable_motors_again(bench.now_ns);
  ASSERT_TRUE(bench.run_until(LinkPhase::Disabled, 5.0));
  EXPECT_EQ(bench.count(Kind::EnableFailed), 1);
}

TEST(ArcosSessionReset, WhileTheLineIsLostTheNextConnectionEnables) {
  RunningBench bench;
  bench.robot.set_flag(arcos::kFlagMotorsEnabled, false);
  bench.run(0.3);
  bench.session.line_lost(bench.now_ns);
  bench.session.enable_motors_again(bench.now_ns);
  EXPECT_EQ(bench.session.state().phase, LinkPhase::Lost);
  bench.session.line_opened(bench.now_ns);
  EXPECT_TRUE(bench.run_until(LinkPhase::Running));
}

TEST(ArcosSessionReset, ChangesNothingWhileTheMotorsRun) {
  RunningBench bench;
  bench.v_m_s = 0.3;
  bench.run(0.5);
  bench.robot.log.clear();
  bench.session.enable_motors_again(bench.now_ns);
  EXPECT_EQ(bench.session.state().phase, LinkPhase::Running);
  bench.run(1.0);
  EXPECT_TRUE(bench.robot.received(CommandId::Enable).empty());
  for (const Received& command : bench.robot.received(CommandId::Vel)) ASSERT_EQ(command.value, 300);
}

}  // namespace
}  // namespace heel
