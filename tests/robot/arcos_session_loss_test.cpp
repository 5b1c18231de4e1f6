// Silence, a broken line, a controller that resets, damaged bytes: how the session recovers, and which pose
// it has afterwards.
#include <gtest/gtest.h>

#include "robot/session_bench.h"

namespace heel {
namespace {

using arcos::CommandId;
using test::Bytes;
using test::Received;
using test::SessionBench;
using Kind = SessionEventKind;

/// Running at (2.0, 0.5) m, 0.3 m/s wanted.
struct DrivingBench : SessionBench {
  DrivingBench() {
    EXPECT_TRUE(run_until(LinkPhase::Running));
    v_m_s = 0.3;
    for (int i = 0; i < 100; ++i) {  // 0.2 m/s by the robot's counters
      robot.sip.x_pos = static_cast<std::uint16_t>(robot.sip.x_pos + 20);
      robot.sip.y_pos = static_cast<std::uint16_t>(robot.sip.y_pos + 5);
      run(0.1);
    }
    run(0.2);
    robot.log.clear();
    expect_position(2.0, 0.5);
  }
  void expect_position(double x_m, double y_m) {
    EXPECT_NEAR(session.state().odometry.x_m, x_m, 1e-9);
    EXPECT_NEAR(session.state().odometry.y_m, y_m, 1e-9);
  }
  void expect_zero_first() {
    const std::size_t first = robot.find(CommandId::Vel);
    ASSERT_LT(first, robot.log.size());
    EXPECT_EQ(robot.log[first].value, 0);
    EXPECT_LT(first, robot.find(CommandId::Enable));
    run(0.3);
    EXPECT_EQ(robot.received(CommandId::Vel).back().value, 300);
  }
};

TEST(ArcosSessionSilence, ReconnectsAndSendsZeroFirst) {
  DrivingBench bench;
  bench.robot.mute = true;
  bench.run(1.8);
  EXPECT_EQ(bench.session.state().phase, LinkPhase::Running);  // the supervisor has already stopped it
  ASSERT_TRUE(bench.run_until(LinkPhase::Lost, 0.5));
  EXPECT_EQ(bench.count(Kind::SipSilence), 1);
  bench.robot.log.clear();
  bench.tick();  // STOP and CLOSE are sent in the tick that found the silence, or in the next
  bench.run(1.5);
  bench.robot.mute = false;
  ASSERT_TRUE(bench.run_until(LinkPhase::Running));
  EXPECT_EQ(bench.session.state().reconnects, 1u);
  bench.expect_zero_first();
  bench.expect_position(2.0, 0.5);
}

TEST(ArcosSessionSilence, StopAndCloseAreSentToASilentRobot) {
  DrivingBench bench;
  bench.robot.mute = true;
  bench.run(3.0);
  const std::size_t stop = bench.robot.find(CommandId::Stop);
  ASSERT_LT(stop + 1, bench.robot.log.size());
  EXPECT_TRUE(bench.robot.log[stop + 1].is(CommandId::Close));
  for (std::size_t i = stop; i < bench.robot.log.size(); ++i) EXPECT_EQ(bench.robot.log[i].value, 0);
}

TEST(ArcosSessionLine, LostAndOpenedAgain) {
  DrivingBench bench;
  bench.session.line_lost(bench.now_ns);
  bench.line_up = false;
  EXPECT_EQ(bench.session.state().phase, LinkPhase::Lost);
  bench.session.advance(bench.now_ns);
  EXPECT_TRUE(bench.session.send(VelocityCommand{}, bench.now_ns).empty());
  bench.run(5.0);
  bench.line_up = true;
  bench.robot.log.clear();
  bench.session.line_opened(bench.now_ns);
  ASSERT_TRUE(bench.run_until(
      LinkPhase::Running));  // the robot's session was left open: it is closed and synchronised again
  EXPECT_TRUE(bench.robot.log[0].is(CommandId::Stop));
  EXPECT_EQ(bench.session.state().reconnects, 1u);
  bench.expect_zero_first();
  bench.expect_position(2.0, 0.5);
}

TEST(ArcosSessionLine, OdometryContinuesWhetherOrNotTheCountersWereZeroed) {
  for (const bool zeroed : {false, true}) {
    DrivingBench bench;
    bench.session.line_lost(bench.now_ns);
    bench.robot.open = false;
    if (zeroed) bench.robot.sip.x_pos = bench.robot.sip.y_pos = 0;
    bench.session.line_opened(bench.now_ns);
    ASSERT_TRUE(bench.run_until(LinkPhase::Running));
    bench.run(0.2);
    bench.expect_position(2.0, 0.5);
    bench.robot.sip.x_pos = static_cast<std::uint16_t>(bench.robot.sip.x_pos + 50);
    bench.run(0.2);
    bench.expect_position(2.05, 0.5);
    EXPECT_EQ(bench.count(Kind::OdometryRebased), zeroed ? 1 : 0);
  }
}

TEST(ArcosSessionReset, AResetNoticeMakesItReconnectWithTheSamePose) {
  for (const std::uint8_t id : Bytes{0xFE, 0xFF}) {
    DrivingBench bench;
    bench.robot.say(arcos::frame_body(Bytes{id}));
    bench.robot.open = false;
    bench.robot.sip.x_pos = bench.robot.sip.y_pos = 0;
    bench.robot.set_flag(arcos::kFlagMotorsEnabled, false);
    bench.run(0.04);
    EXPECT_EQ(bench.session.state().phase, LinkPhase::Syncing);
    EXPECT_EQ(bench.count(Kind::ControllerReset), 1);
    bench.robot.log.clear();
    ASSERT_TRUE(bench.run_until(LinkPhase::Running));
    bench.expect_zero_first();
    bench.expect_position(2.0, 0.5);
  }
}

TEST(ArcosSessionOpen, NoSipAfterOpenStartsAgain) {
  SessionBench bench;
  ASSERT_TRUE(bench.run_until(LinkPhase::Opening));
  bench.robot.open = false;
  bench.robot.mute = true;
  bench.run(0.2);
  EXPECT_TRUE(bench.run_until(LinkPhase::Lost, 4.0));
  bench.robot.mute = false;
  EXPECT_TRUE(bench.run_until(LinkPhase::Running));
}

TEST(ArcosSessionDamage, DamagedSipsAreCountedAndIgnored) {
  DrivingBench bench;
  const std::uint64_t sips = bench.session.state().sips;
  for (int i = 0; i < 10; ++i) {
    const arcos::Frame frame = arcos::encode_sip(bench.robot.sip);
    Bytes bytes(frame.bytes().begin(), frame.bytes().end());
    bytes[10] ^= 0x40;
    bench.session.receive(bytes, bench.now_ns);
  }
  EXPECT_EQ(bench.session.state().checksum_errors, 10u);
  EXPECT_EQ(bench.session.state().sips, sips);
  bench.run(1.0);
  EXPECT_EQ(bench.session.state().sips, sips + 10);
  EXPECT_EQ(bench.session.state().phase, LinkPhase::Running);
}

TEST(ArcosSessionDamage, AFalseHeaderDelaysSipsForLessThanTheSupervisorsTimeout) {
  DrivingBench bench;
  bench.session.receive(Bytes{0xFA, 0xFB, 249}, bench.now_ns);
  const TimeNs begin_ns = bench.now_ns;
  const std::uint64_t sips = bench.session.state().sips;
  while (bench.session.state().sips == sips && bench.now_ns - begin_ns < kNsPerS) bench.tick();
  EXPECT_LT(seconds_from_ns(bench.now_ns - begin_ns), 0.8 * SupervisorConfig{}.sip_timeout_s);
  bench.run(1.0);
  EXPECT_GE(bench.session.state().sips, sips + 12);  // none was lost
}

TEST(ArcosSessionDamage, AGoodChecksumWithAWrongLayoutIsReported) {
  DrivingBench bench;
  const arcos::Frame frame = arcos::frame_body(Bytes{0x33, 1, 2, 3});
  bench.session.receive(frame.bytes(), bench.now_ns);
  bench.tick();
  EXPECT_EQ(bench.count(Kind::BadPacket), 1);
  EXPECT_EQ(bench.session.state().phase, LinkPhase::Running);
}

TEST(ArcosSessionStamp, SipIsStampedAtItsFirstByte) {
  DrivingBench bench;
  const arcos::Frame frame = arcos::encode_sip(bench.robot.sip);
  bench.session.receive(frame.bytes().first(7), bench.now_ns + 1);
  bench.session.receive(frame.bytes().subspan(7), bench.now_ns + 5'000'000);
  EXPECT_EQ(bench.session.state().odometry.t_ns, bench.now_ns + 1);
}

}  // namespace
}  // namespace heel
