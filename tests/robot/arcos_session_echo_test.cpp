// A line that sends back what heeld sends is named, and never driven; a robot behind it is.
#include <gtest/gtest.h>

#include <string>

#include "robot/session_bench.h"

namespace heel {
namespace {

using arcos::CommandId;
using test::bench_config;
using test::SessionBench;
using Kind = SessionEventKind;

/// Nothing but SYNC0, SYNC1, SYNC2 and CLOSE: OPEN has the number of SYNC1, and an argument.
void expect_never_opened(const SessionBench& bench) {
  for (const test::Received& one : bench.robot.log) {
    EXPECT_LE(one.id, 2);
    EXPECT_FALSE(one.is(CommandId::Open, 1));
  }
}

TEST(ArcosSessionEcho, ALoopBackPlugIsNamedOnceAndNeverOpened) {
  for (const char* address : {"serial:/dev/ttyUSB0@38400", "serial:/dev/ttyUSB0@9600", "tcp:robot:5760"}) {
    for (const char* model : {"auto", "p3at-sh"}) {
      for (const double after_s : {0.0, 0.05, 0.3, 0.6}) {
        for (const std::size_t piece : {1000u, 3u, 1u}) {
          SCOPED_TRACE(std::string(address) + ' ' + model + ' ' + std::to_string(after_s) + ' ' +
                       std::to_string(piece));
          RobotConfig config = bench_config(address);
          config.model = model;
          SessionBench bench(config);
          bench.robot.mute = true;
          bench.line_echoes = true;
          bench.echo_after_ns = ns_from_seconds(after_s);
          bench.echo_piece = piece;
          for (int reopened = 0; reopened < 3; ++reopened) {
            bench.run(25.0);
            bench.session.line_opened(bench.now_ns);
          }
          EXPECT_EQ(bench.count(Kind::LineEchoes), 1);
          EXPECT_EQ(bench.count(Kind::ModelMissing), 0);
          EXPECT_EQ(bench.count(Kind::OtherBytes), 0);
          EXPECT_EQ(bench.count(Kind::BadPacket), 0);
          EXPECT_EQ(bench.session.state().phase, LinkPhase::Lost);
          expect_never_opened(bench);
        }
      }
    }
  }
}

TEST(ArcosSessionEcho, OneThatComesLaterThanASweepIsNeverOpened) {
  for (const char* address : {"serial:/dev/ttyUSB0@38400", "tcp:robot:5760"}) {
    for (double after_s = 0.1; after_s < 12.0; after_s += 0.1) {
      SCOPED_TRACE(std::string(address) + ' ' + std::to_string(after_s));
      RobotConfig config = bench_config(address);
      config.model = "p3at-sh";
      SessionBench bench(config);
      bench.robot.mute = bench.line_echoes = true;
      bench.echo_after_ns = ns_from_seconds(after_s);
      bench.run(90.0);
      EXPECT_GE(bench.count(Kind::LineEchoes), 1);
      expect_never_opened(bench);
    }
  }
}

TEST(ArcosSessionEcho, IsSaidWithinSevenSeconds) {
  SessionBench bench(bench_config("serial:/dev/ttyUSB0@38400"));
  bench.robot.mute = bench.line_echoes = true;
  bench.run(7.0);
  EXPECT_EQ(bench.count(Kind::LineEchoes), 1);
}

TEST(ArcosSessionEcho, ARobotBehindItIsDriven) {
  for (const int baud : {9600, 38400}) {
    SessionBench bench(bench_config("serial:/dev/ttyUSB0@38400"));
    bench.robot.baud = baud;
    bench.line_echoes = true;
    EXPECT_TRUE(bench.run_until(LinkPhase::Running)) << baud;
    bench.run(5.0);
    EXPECT_EQ(bench.session.state().phase, LinkPhase::Running) << baud;
    EXPECT_EQ(bench.count(Kind::LineEchoes), 0) << baud;
    EXPECT_EQ(bench.count(Kind::SipSilence), 0) << baud;
  }
}

TEST(ArcosSessionEcho, ItsOwnPulseDoesNotConfirmAFasterLine) {
  SessionBench bench(bench_config("serial:/dev/ttyUSB0@115200"));
  bench.robot.baud = 9600;
  bench.robot.config.autobaud = std::uint8_t{2};
  bench.robot.host_bauds_to_follow = 0;
  bench.line_echoes = true;
  EXPECT_TRUE(bench.run_until(LinkPhase::Running));
  EXPECT_EQ(bench.count(Kind::RateRaised), 0);
  EXPECT_EQ(bench.count(Kind::RateRefused), 1);
}

TEST(ArcosSessionEcho, ARobotInItsPlaceIsDrivenAndTheNextEchoIsNamedAgain) {
  SessionBench bench;
  bench.robot.mute = bench.line_echoes = true;
  bench.run(20.0);
  bench.robot.mute = bench.line_echoes = false;
  EXPECT_TRUE(bench.run_until(LinkPhase::Running));
  EXPECT_EQ(bench.count(Kind::LineEchoes), 1);
  bench.robot.mute = bench.line_echoes = true;
  bench.run(40.0);
  EXPECT_EQ(bench.count(Kind::LineEchoes), 2);
}

}  // namespace
}  // namespace heel
