// The session raises the rate of a slow line before the motors run, and recovers when that fails.
#include <gtest/gtest.h>

#include <algorithm>

#include "robot/session_bench.h"

namespace heel {
namespace {

using arcos::CommandId;
using test::bench_config;
using test::SessionBench;
using Kind = SessionEventKind;

/// A robot at 9600 baud; the address asks for 38400.
struct SlowBench : SessionBench {
  explicit SlowBench(const char* address = "serial:/dev/ttyS0@38400") : SessionBench(bench_config(address)) {
    robot.baud = 9600;
    robot.config.autobaud = std::uint8_t{2};
  }
  bool run_until_asked() {
    for (int i = 0; i < 1000 && robot.received(CommandId::HostBaud).empty(); ++i) tick();
    return !robot.received(CommandId::HostBaud).empty();
  }
};

TEST(ArcosSessionRate, IsRaisedBeforeLimitsAndMotors) {
  SlowBench bench;
  ASSERT_TRUE(bench.run_until(LinkPhase::Running));
  EXPECT_EQ(bench.robot.baud, 38400);
  EXPECT_EQ(bench.session.wanted_baud(), 38400);
  EXPECT_EQ(bench.count(Kind::RateRaised), 1);
  const auto& log = bench.robot.log;
  const std::size_t asked = bench.robot.find(CommandId::HostBaud);
  ASSERT_LT(asked, log.size());
  EXPECT_TRUE(log[asked].is(CommandId::HostBaud, 2));
  const std::size_t pulse = bench.robot.find(CommandId::Pulse, asked);
  EXPECT_EQ(pulse, asked + 1);
  EXPECT_GE(log.at(pulse).t_ns - log[asked].t_ns, 20 * kNsPerMs);
  EXPECT_LT(pulse, bench.robot.find(CommandId::SetV));
  EXPECT_LT(pulse, bench.robot.find(CommandId::Enable));
  EXPECT_EQ(bench.robot.received(CommandId::HostBaud).size(), 1u);
  EXPECT_EQ(bench.count(Kind::Synchronised), 1);
}

TEST(ArcosSessionRate, IsKeptOverAReconnectionAndRaisedAgainAfterARestart) {
  SlowBench bench;
  ASSERT_TRUE(bench.run_until(LinkPhase::Running));
  bench.session.line_lost(bench.now_ns);
  bench.session.line_opened(bench.now_ns);
  ASSERT_TRUE(bench.run_until(LinkPhase::Running, 4.0));
  EXPECT_EQ(bench.count(Kind::RateRaised), 1);

  bench.session.line_lost(bench.now_ns);
  bench.robot.open = false;
  bench.robot.baud = 9600;
  bench.session.line_opened(bench.now_ns);
  ASSERT_TRUE(bench.run_until(LinkPhase::Running, 30.0));
  EXPECT_EQ(bench.count(Kind::RateRaised), 2);
  EXPECT_EQ(bench.robot.baud, 38400);
}

TEST(ArcosSessionRate, IsNotChangedWhereTheRobotCannotOrTheAddressDoesNotAskForIt) {
  for (const int autobaud : {-1, 0, 1}) {
    SlowBench bench;
    bench.robot.config.autobaud.reset();
    if (autobaud >= 0) bench.robot.config.autobaud = static_cast<std::uint8_t>(autobaud);
    ASSERT_TRUE(bench.run_until(LinkPhase::Running));
    EXPECT_TRUE(bench.robot.received(CommandId::HostBaud).empty()) << autobaud;
    EXPECT_EQ(bench.session.wanted_baud(), 9600);
  }
  for (const char* address : {"serial:/dev/ttyS0@9600", "tcp:robot:8101"}) {
    SlowBench bench(address);
    if (address[0] == 't') bench.robot.baud = 0;
    ASSERT_TRUE(bench.run_until(LinkPhase::Running));
    EXPECT_TRUE(bench.robot.received(CommandId::HostBaud).empty()) << address;
  }
  SlowBench faster;
  faster.robot.baud = 115200;
  ASSERT_TRUE(faster.run_until(LinkPhase::Running, 30.0));
  EXPECT_TRUE(faster.robot.received(CommandId::HostBaud).empty());
}

TEST(ArcosSessionRate, ARobotThatKeepsItsRateIsFoundThereAndNotAskedAgain) {
  SlowBench bench;
  bench.robot.host_bauds_to_follow = 0;
  ASSERT_TRUE(bench.run_until_asked());
  ASSERT_TRUE(bench.run_until(LinkPhase::Running, 2.0));
  EXPECT_EQ(bench.session.wanted_baud(), 9600);
  EXPECT_EQ(bench.count(Kind::RateRefused), 1);
  EXPECT_EQ(bench.count(Kind::SipSilence), 0);

  bench.session.line_lost(bench.now_ns);
  bench.session.line_opened(bench.now_ns);
  ASSERT_TRUE(bench.run_until(LinkPhase::Running, 4.0));
  EXPECT_EQ(bench.robot.received(CommandId::HostBaud).size(), 1u);
}

TEST(ArcosSessionRate, ARobotThatCannotBeHeardAtTheNewRateIsSwitchedBack) {
  SlowBench bench;
  bench.robot.unheard_at = 38400;
  ASSERT_TRUE(bench.run_until_asked());
  EXPECT_EQ(bench.robot.baud, 38400);
  ASSERT_TRUE(bench.run_until(LinkPhase::Running, 2.0));
  EXPECT_EQ(bench.robot.baud, 9600);
  EXPECT_EQ(bench.session.wanted_baud(), 9600);
  EXPECT_EQ(bench.count(Kind::Synchronised), 1);  // the connection was never lost
}

TEST(ArcosSessionRate, ARobotThatDoesNotSwitchBackIsFoundByTheSweep) {
  SlowBench bench;
  bench.robot.host_bauds_to_follow = 1;  // it changes its rate once, and not back
  bench.robot.unheard_at = 38400;
  ASSERT_TRUE(bench.run_until_asked());
  bench.run(2.0);
  EXPECT_EQ(bench.session.wanted_baud(), 9600);
  EXPECT_EQ(bench.robot.baud, 38400);
  EXPECT_TRUE(bench.robot.received(CommandId::Enable).empty());
  bench.robot.unheard_at = 0;
  ASSERT_TRUE(bench.run_until(LinkPhase::Running, 30.0));
  EXPECT_EQ(bench.session.wanted_baud(), 38400);
  EXPECT_EQ(bench.robot.received(CommandId::HostBaud).size(), 2u);
}

int warnings(const SessionBench& bench) {
  return static_cast<int>(std::count_if(bench.events.begin(), bench.events.end(),
                                        [](const SessionEvent& event) { return is_warning(event.kind); }));
}

// A robot's port after CLOSE: at the power-on rate, or as it was. A driver finds either.
TEST(ArcosSessionRate, AfterItsOwnCloseTheRobotIsFoundAtOnceAtEitherRate) {
  for (const bool falls_back : {true, false}) {
    SlowBench bench;
    if (falls_back) bench.robot.rate_after_close = 9600;
    ASSERT_TRUE(bench.run_until(LinkPhase::Running));
    for (int restart = 0; restart < 4; ++restart) {
      const auto bytes = bench.session.close(bench.now_ns);
      bench.robot.receive(bytes, bench.session.wanted_baud(), bench.now_ns);
      ASSERT_EQ(bench.robot.baud, falls_back ? 9600 : 38400);
      if (restart % 2 == 1)
        bench.session = ArcosSession(bench_config("serial:/dev/ttyS0@38400"));  // another process
      bench.events.clear();
      bench.session.line_opened(bench.now_ns);
      ASSERT_TRUE(bench.run_until(LinkPhase::Running, 2.5)) << falls_back << restart;
      EXPECT_EQ(bench.robot.baud, 38400);
      EXPECT_EQ(warnings(bench), 0) << falls_back << restart;
    }
  }
}

TEST(ArcosSessionRate, ASilentRobotThatIsClosedIsFoundAtThePowerOnRate) {
  SlowBench bench;
  bench.robot.rate_after_close = 9600;
  ASSERT_TRUE(bench.run_until(LinkPhase::Running));
  bench.robot.mute = true;
  ASSERT_TRUE(bench.run_until(LinkPhase::Lost));
  bench.run(0.5);
  bench.robot.mute = false;
  EXPECT_EQ(bench.robot.baud, 9600) << "the session has sent CLOSE";
  ASSERT_TRUE(bench.run_until(LinkPhase::Running, 3.0));
  EXPECT_EQ(bench.robot.baud, 38400);
}

TEST(ArcosSessionRate, LineLostWhileTheNewRateIsTried) {
  SlowBench bench;
  ASSERT_TRUE(bench.run_until_asked());
  for (int i = 0; i < 10 && bench.session.wanted_baud() == 9600; ++i) bench.tick();
  ASSERT_EQ(bench.session.wanted_baud(), 38400);
  bench.session.line_lost(bench.now_ns);
  bench.session.line_opened(bench.now_ns);
  EXPECT_EQ(bench.session.wanted_baud(), 9600);  // the last at which it was heard
  ASSERT_TRUE(bench.run_until(LinkPhase::Running, 30.0));
  EXPECT_EQ(bench.session.wanted_baud(), 38400);
}

}  // namespace
}  // namespace heel
