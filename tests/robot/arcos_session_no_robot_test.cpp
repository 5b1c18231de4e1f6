// A line on which no robot answers: it is off, another device is there, or the line ends. A person is told at
// the first clear evidence, once, and rarely after that.
#include <gtest/gtest.h>

#include <string>
#include <string_view>

#include "robot/session_bench.h"

namespace heel {
namespace {

using test::bench_config;
using test::SessionBench;
using Kind = SessionEventKind;

TEST(ArcosSessionLineWithoutRobot, TextOfAnotherDeviceIsReported) {
  for (const char* address : {"serial:/dev/ttyUSB0@38400", "tcp:robot:22"}) {
    SessionBench bench(bench_config(address));
    const bool is_tcp = address[0] == 't';
    const std::string_view text = is_tcp ? "SSH-2.0-OpenSSH_9.2\r\n" : "$GPGGA,120000,4807.0,N\r\n";
    bench.robot.chatter.assign(text.begin(), text.end());
    bench.robot.chatters = true;
    bench.robot.baud = is_tcp ? 0 : 19200;
    bench.run(16.0);
    bench.session.line_opened(bench.now_ns);
    bench.run(16.0);
    EXPECT_EQ(bench.count(Kind::OtherDevice), 1) << "once, not for each sweep";
    EXPECT_EQ(bench.count(Kind::NoAnswer) + bench.count(Kind::NoAnswerTcp), 0);
    EXPECT_EQ(bench.session.heard_text(), text.substr(0, text.size() - 2));
  }
}

TEST(ArcosSessionLineWithoutRobot, BytesThatAreNoTextAreNotSilence) {
  for (const char* address : {"serial:/dev/ttyUSB0@38400", "tcp:robot:5760"}) {
    SessionBench bench(bench_config(address));
    const bool is_tcp = address[0] == 't';
    bench.robot.chatter = {0xfd, 9, 0, 0, 1, 1, 1, 0, 0, 0, 2, 3, 4, 5, 6, 7, 8, 9, 0x12, 0x34};
    bench.robot.chatters = true;
    bench.robot.baud = is_tcp ? 0 : 19200;
    bench.run(16.0);
    EXPECT_GE(bench.count(Kind::OtherBytes), 1);
    EXPECT_EQ(bench.count(Kind::NoAnswer) + bench.count(Kind::NoAnswerTcp), 0);
  }
}

TEST(ArcosSessionLineWithoutRobot, AServerThatEndsTheConnectionWithATextIsNamedOnce) {
  SessionBench bench(bench_config("tcp:robot:8101"));
  const std::string_view text = "heel-sim: in use by another client\r\n";
  bench.robot.chatter.assign(text.begin(), text.end());
  bench.robot.chatters = true;
  for (int attempt = 0; attempt < 5; ++attempt) {
    bench.tick();
    bench.session.line_lost(bench.now_ns);
    bench.tick();
    bench.session.line_opened(bench.now_ns);
    EXPECT_EQ(bench.session.state().phase, LinkPhase::Lost) << "not syncing for a moment each second";
  }
  bench.tick();
  EXPECT_EQ(bench.count(Kind::LineOpened), 1);
  EXPECT_EQ(bench.count(Kind::OtherDevice), 1);
  EXPECT_EQ(bench.count(Kind::LineLost), 0) << "it was never up";
  EXPECT_EQ(bench.session.heard_text(), "heel-sim: in use by another client");
  bench.robot.chatters = false;
  EXPECT_TRUE(bench.run_until(LinkPhase::Running));
}

/// The daemon's link: a line without an answer is opened again after a second.
void run_and_reopen(SessionBench& bench, double seconds) {
  for (const TimeNs end_ns = bench.now_ns + ns_from_seconds(seconds); bench.now_ns < end_ns;) {
    bench.tick();
    if (!bench.session.line_exhausted()) continue;
    bench.session.line_lost(bench.now_ns);
    bench.run(1.0);
    bench.session.line_opened(bench.now_ns);
  }
}

TEST(ArcosSessionLineWithoutRobot, ARobotThatIsOffIsSaidOnceAndThenRarely) {
  for (const char* address : {"serial:/dev/ttyUSB0@38400", "tcp:robot:8101"}) {
    SCOPED_TRACE(address);
    SessionBench bench(bench_config(address));
    const Kind no_answer = address[0] == 't' ? Kind::NoAnswerTcp : Kind::NoAnswer;
    bench.robot.mute = true;
    run_and_reopen(bench, 55.0);
    EXPECT_EQ(bench.count(no_answer), 1);
    EXPECT_EQ(bench.count(Kind::LineOpened), 1);
    EXPECT_EQ(bench.count(Kind::LineLost), 0) << "it was never up";
    EXPECT_EQ(bench.session.state().phase, LinkPhase::Syncing) << "and does not become lost each time";
    const int rates_tried = bench.count(Kind::TryingBaud);
    run_and_reopen(bench, 3600.0);
    EXPECT_GE(bench.count(no_answer), 5);
    EXPECT_LE(bench.count(no_answer), 7) << "after 1, 2, 4 … minutes";
    EXPECT_EQ(bench.count(Kind::LineOpened), 1);
    EXPECT_EQ(bench.count(Kind::TryingBaud), rates_tried);
    bench.robot.mute = false;
    ASSERT_TRUE(bench.run_until(LinkPhase::Running, 40.0));
    bench.session.line_lost(bench.now_ns);
    bench.tick();
    EXPECT_EQ(bench.count(Kind::LineLost), 1);
    EXPECT_EQ(bench.session.state().phase, LinkPhase::Lost);
    bench.robot.mute = true;
    const int before = bench.count(no_answer);
    bench.session.line_opened(bench.now_ns);
    run_and_reopen(bench, 20.0);
    EXPECT_EQ(bench.count(no_answer), before + 1) << "another outage is news";
  }
}

TEST(ArcosSessionLineWithoutRobot, ALineThatEndsBeforeAnAnswerWasNotUp) {
  SessionBench bench(bench_config("tcp:robot:8101"));
  bench.robot.mute = true;
  for (int attempt = 0; attempt < 20; ++attempt) {
    bench.run(0.5);
    bench.session.line_lost(bench.now_ns);
    bench.session.line_opened(bench.now_ns);
  }
  EXPECT_EQ(bench.count(Kind::LineEnded), 1);
  EXPECT_EQ(bench.count(Kind::LineLost), 0);
  EXPECT_EQ(bench.count(Kind::LineOpened), 1);
}

TEST(ArcosSessionLineWithoutRobot, TextIsNamedAtItsFirstWholeLine) {
  struct Row {
    const char* address;
    int baud;
    double within_s;
  };
  for (const Row& row : {Row{"tcp:robot:10110", 0, 1.2}, Row{"serial:/dev/ttyUSB0@38400", 9600, 6.0},
                         Row{"serial:/dev/ttyUSB0@9600", 9600, 1.2}}) {
    SCOPED_TRACE(row.address);
    SessionBench bench(bench_config(row.address));
    bench.robot.mute = true;
    bench.robot.baud = row.baud;
    int seconds_of_day = 0;
    for (double t_s = 0.0; t_s < row.within_s && bench.count(Kind::OtherDevice) == 0; t_s += 0.02) {
      bench.robot.chatters = static_cast<int>(t_s) >= seconds_of_day;
      if (bench.robot.chatters) {
        const std::string line =
            "$GPGGA,1200" + std::to_string(10 + seconds_of_day++) + ".00,4807.0,N,01131.0,E*4\r\n";
        bench.robot.chatter.assign(line.begin(), line.end());
      }
      bench.tick();
    }
    EXPECT_EQ(bench.count(Kind::OtherDevice), 1);
    EXPECT_TRUE(bench.session.heard_text().starts_with("$GPGGA,1200"));
  }
}

TEST(HeardText, IsALineOfText) {
  const auto heard = [](std::string_view text) {
    HeardText out;
    out.hear({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
    return std::string(out.text());
  };
  EXPECT_EQ(heard("OK\r\nERROR: {1}\r\nmore"), "ERROR: (1)") << "braces would be placeholders";
  EXPECT_EQ(heard("short"), "");
  EXPECT_EQ(heard("WMS2\r"), "");
  EXPECT_EQ(heard("abcd\x01\x02\x03\x04"
                  "efgh"),
            "");
  EXPECT_EQ(heard(std::string(60, 'x')), std::string(40, 'x'));
}

}  // namespace
}  // namespace heel
