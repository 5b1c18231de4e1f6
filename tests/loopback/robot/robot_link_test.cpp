// The link and the simulated P3-AT at the two ends of real lines, in real time: pty and TCP, hang-up,
// reconnection.
#include "robot/robot_link.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "arcos/command_codec.h"
#include "arcos/commands.h"
#include "loopback/robot/robot_thread.h"
#include "realtime/clock.h"
#include "support/process.h"

namespace heel {
namespace {

using test::pty_address;
using test::RobotThread;

class LinkBench {
 public:
  explicit LinkBench(const std::string& address) : LinkBench(config(address)) {}
  explicit LinkBench(const RobotConfig& config) : link(config) {}
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
    link.receive_until(now_ns + 20 * kNsPerMs);
  }
  void run(double seconds) {
    for (const TimeNs end_ns = monotonic_now_ns() + ns_from_seconds(seconds); monotonic_now_ns() < end_ns;)
      tick();
  }
  /// False after a time that is enough also for a busy machine.
  template <typename Condition>
  bool run_until(Condition condition) {
    for (const double end_s = test::monotonic_s() + test::kPatience_s; test::monotonic_s() < end_s;) {
      tick();
      if (condition()) return true;
    }
    return false;
  }
  bool run_until(LinkPhase phase) {
    return run_until([&] { return link.state().phase == phase; });
  }
  bool run_until_driving(const RobotThread& robot) {
    v_m_s = 0.3;
    return run_until([&] { return std::abs(robot.truth().v_m_s - v_m_s) < 0.01; });
  }
  RobotLink link;
  double v_m_s = 0.0;
  TimeNs longest_ns = 0;
};

bool closed_and_at_rest(const RobotThread& robot) {
  return test::eventually([&] {
    const sim::RobotTruth truth = robot.truth();
    return truth.session == sim::Session::Waiting && std::abs(truth.v_m_s) < 1e-3;
  });
}

TEST(RobotLinkOverPty, DrivesAndShutsDown) {
  const std::string address = pty_address("drive");
  RobotThread robot(address);
  LinkBench bench(address);
  ASSERT_TRUE(bench.run_until(LinkPhase::Running));
  EXPECT_TRUE(bench.run_until_driving(robot)) << robot.truth().v_m_s;
  EXPECT_TRUE(bench.run_until([&] { return bench.link.state().odometry.x_m > 0.2; }));
  EXPECT_EQ(bench.link.state().checksum_errors, 0u);

  const TimeNs begin_ns = monotonic_now_ns();
  bench.link.shutdown(begin_ns);
  EXPECT_GT(monotonic_now_ns() - begin_ns, 20 * kNsPerMs) << "an adapter needs time to send the last bytes";
  EXPECT_EQ(bench.link.state().phase, LinkPhase::Closed);
  EXPECT_TRUE(closed_and_at_rest(robot));
}

TEST(RobotLinkOverPty, ShutsDownWithinFourTenthsOfASecond) {
  // A busy machine may delay one shutdown; a link that is too slow is slow every time.
  TimeNs shortest_ns = kNsPerS;
  for (int i = 0; i < 5 && shortest_ns >= 400 * kNsPerMs; ++i) {
    const std::string address = pty_address("shutdown");
    RobotThread robot(address);
    LinkBench bench(address);
    ASSERT_TRUE(bench.run_until(LinkPhase::Running));
    const TimeNs begin_ns = monotonic_now_ns();
    bench.link.shutdown(begin_ns);
    shortest_ns = std::min(shortest_ns, monotonic_now_ns() - begin_ns);
  }
  EXPECT_LT(shortest_ns, 400 * kNsPerMs);
}

TEST(RobotLinkOverPty, FindsTheRateOfARobotAndRaisesIt) {
  const std::string address = pty_address("rate");
  RobotThread robot(address, 9600);
  LinkBench bench(address + "@57600");
  ASSERT_TRUE(bench.run_until(LinkPhase::Running));
  EXPECT_EQ(robot.truth().baud, 57600);
  EXPECT_TRUE(bench.run_until_driving(robot)) << robot.truth().v_m_s;
}

TEST(RobotLinkOverPty, SipsAreStampedWhenTheyArriveNotAtTheTick) {
  const std::string address = pty_address("stamp");
  RobotThread robot(address);
  LinkBench bench(address);
  ASSERT_TRUE(bench.run_until(LinkPhase::Running));
  // One long wait in place of many ticks: SIPs that arrive in it have their own arrival times. A busy machine
  // may disturb one of the waits.
  bool stamped_before_the_deadline = false;
  for (int i = 0; i < 10 && !stamped_before_the_deadline; ++i) {
    const TimeNs begin_ns = monotonic_now_ns();
    const TimeNs deadline_ns = begin_ns + 300 * kNsPerMs;
    const std::uint64_t sips = bench.link.state().sips;
    bench.link.receive_until(deadline_ns);
    EXPECT_GE(monotonic_now_ns(), deadline_ns);
    const TimeNs t_ns = bench.link.state().odometry.t_ns;
    stamped_before_the_deadline = bench.link.state().sips > sips && t_ns > begin_ns && t_ns < deadline_ns;
  }
  EXPECT_TRUE(stamped_before_the_deadline);
}

TEST(RobotLinkOverPty, ReconnectsAfterAHangUp) {
  const std::string address = pty_address("hangup");
  auto robot = std::make_unique<RobotThread>(address);
  LinkBench bench(address);
  ASSERT_TRUE(bench.run_until(LinkPhase::Running));
  robot.reset();
  ASSERT_TRUE(bench.run_until(LinkPhase::Lost));
  EXPECT_TRUE(bench.run_until([&] { return bench.link.open_failures() > 0; }));
  EXPECT_NE(bench.link.last_open_error().find("No such file"), std::string::npos);
  robot = std::make_unique<RobotThread>(address);
  EXPECT_TRUE(bench.run_until(LinkPhase::Running));
  EXPECT_EQ(bench.link.state().reconnects, 1u);
}

TEST(RobotLinkOverPty, ADestroyedLinkLeavesTheRobotClosed) {
  const std::string address = pty_address("destroyed");
  RobotThread robot(address);
  {
    LinkBench bench(address);
    ASSERT_TRUE(bench.run_until(LinkPhase::Running));
    ASSERT_TRUE(bench.run_until_driving(robot)) << robot.truth().v_m_s;
  }
  EXPECT_TRUE(closed_and_at_rest(robot));
}

/// A pty whose peer reads only when the test says so.
class UnreadPty {
 public:
  UnreadPty() {
    master_ = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
    std::array<char, 128> name{};
    if (master_ < 0 || grantpt(master_) != 0 || unlockpt(master_) != 0 ||
        ptsname_r(master_, name.data(), name.size()) != 0)
      throw std::runtime_error("no pty");
    path_ = name.data();
    slave_ = open(path_.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK);
    termios raw{};
    tcgetattr(slave_, &raw);
    cfmakeraw(&raw);
    tcsetattr(slave_, TCSANOW, &raw);
  }
  ~UnreadPty() {
    close(slave_);
    close(master_);
  }
  UnreadPty(const UnreadPty&) = delete;
  UnreadPty& operator=(const UnreadPty&) = delete;

  std::string address() const { return "pty:" + path_; }
  /// Writes zeros into the line until its driver takes no more.
  void fill() {
    const std::array<char, 512> zeros{};
    for (int refused = 0; refused < 20; test::sleep_s(0.001)) {
      const ssize_t taken = write(slave_, zeros.data(), zeros.size());
      refused = taken > 0 ? 0 : refused + 1;
    }
  }
  /// What the line has carried so far, without fill()'s zeros at the front.
  std::vector<std::uint8_t> take() {
    std::array<std::uint8_t, 4096> chunk{};
    for (ssize_t size; (size = read(master_, chunk.data(), chunk.size())) > 0;)
      carried_.insert(carried_.end(), chunk.begin(), chunk.begin() + size);
    const auto first = std::find_if(carried_.begin(), carried_.end(), [](auto byte) { return byte != 0; });
    return {first, carried_.end()};
  }

  /// Sends back at most `most` bytes of what the line has carried.
  void echo(std::size_t most) {
    std::array<std::uint8_t, 512> chunk{};
    const ssize_t size = read(master_, chunk.data(), std::min(most, chunk.size()));
    if (size <= 0) return;
    EXPECT_EQ(write(master_, chunk.data(), static_cast<std::size_t>(size)), size);
  }

 private:
  int master_ = -1, slave_ = -1;
  std::string path_;
  std::vector<std::uint8_t> carried_;
};

/// No robot answered on it: it ends, and is not called lost.
TEST(RobotLinkOverPty, ALineThatTakesNothingForASecondEnds) {
  UnreadPty pty;
  LinkBench bench(pty.address());
  ASSERT_TRUE(bench.run_until(LinkPhase::Syncing));
  pty.fill();
  std::vector<SessionEventKind> said;
  EXPECT_TRUE(bench.run_until([&] {
    for (SessionEvent event; bench.link.next_event(event);) said.push_back(event.kind);
    return std::count(said.begin(), said.end(), SessionEventKind::LineEnded) > 0;
  }));
  EXPECT_EQ(std::count(said.begin(), said.end(), SessionEventKind::LineLost), 0);
  EXPECT_EQ(bench.link.state().phase, LinkPhase::Syncing);
}

TEST(RobotLinkOverPty, ALoopBackPlugIsNamed) {
  for (const std::size_t most : {512u, 5u}) {
    UnreadPty pty;
    RobotConfig config = LinkBench::config(pty.address());
    config.model = "p3at-sh";
    LinkBench bench(config);
    std::vector<SessionEventKind> said;
    EXPECT_TRUE(bench.run_until([&] {
      pty.echo(most);
      for (SessionEvent event; bench.link.next_event(event);) said.push_back(event.kind);
      return std::find(said.begin(), said.end(), SessionEventKind::LineEchoes) != said.end();
    })) << most;
    EXPECT_EQ(std::count(said.begin(), said.end(), SessionEventKind::Synchronised), 0) << most;
  }
}

TEST(RobotLinkOverPty, ShutdownSendsTheRestOfAPacketBeforeStop) {
  const arcos::Frame sync0 = arcos::encode_plain(arcos::CommandId::Sync0);
  const arcos::Frame stop = arcos::encode_plain(arcos::CommandId::Stop);
  std::vector<std::uint8_t> carried;
  // A busy machine may delay the thread that reads until shutdown() has given up.
  for (int attempt = 0; attempt < 5 && carried.empty(); ++attempt) {
    UnreadPty pty;
    LinkBench bench(pty.address());
    bench.run(0.1);
    ASSERT_EQ(bench.link.state().phase, LinkPhase::Syncing) << "it listens before it sends SYNC0";
    pty.fill();
    bench.run(0.6);
    std::atomic<bool> done{false};
    std::jthread reader([&] {
      while (!done) {
        pty.take();
        test::sleep_s(0.001);
      }
    });
    bench.link.shutdown(monotonic_now_ns());
    test::sleep_s(0.05);
    done = true;
    reader.join();
    carried = pty.take();
  }
  std::vector<std::uint8_t> expected(sync0.bytes().begin(), sync0.bytes().end());
  expected.insert(expected.end(), stop.bytes().begin(), stop.bytes().end());
  ASSERT_GE(carried.size(), expected.size());
  carried.resize(expected.size());
  EXPECT_EQ(carried, expected);
}

TEST(RobotLinkOverTcp, Drives) {
  RobotThread robot("tcp:127.0.0.1:0");
  LinkBench bench(robot.address());
  ASSERT_TRUE(bench.run_until(LinkPhase::Running));
  EXPECT_TRUE(bench.run_until_driving(robot)) << robot.truth().v_m_s;
}

TEST(RobotLinkWithoutARobot, NeitherBlocksNorEnds) {
  // A busy machine may delay one of the runs; a link that blocks delays every one.
  TimeNs longest_ns = kNsPerS;
  for (int i = 0; i < 5 && longest_ns >= 50 * kNsPerMs; ++i) {
    LinkBench bench("pty:/nonexistent/robot");
    EXPECT_TRUE(bench.run_until([&] { return bench.link.open_failures() > 0; }));
    bench.run(0.5);
    EXPECT_EQ(bench.link.state().phase, LinkPhase::Closed);
    longest_ns = std::min(longest_ns, bench.longest_ns);
  }
  EXPECT_LT(longest_ns, 50 * kNsPerMs);
}

}  // namespace
}  // namespace heel
