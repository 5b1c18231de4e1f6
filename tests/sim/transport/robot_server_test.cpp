// The server between robot and line, in virtual time: a process that was held up must not make the robot look
// deaf.
#include "sim/transport/robot_server.h"

#include <algorithm>
#include <string>

#include "sim/robot/virtual_client.h"

namespace heel::sim {
namespace {

using arcos::CommandId;
using test::fast_exact_settings;

/// A line whose client is always there.
class ScriptedLine : public Transport {
 public:
  bool client_present() override { return true; }
  std::size_t read(std::span<std::uint8_t> into) override {
    const std::size_t size = std::min(into.size(), from_client.size());
    std::copy_n(from_client.begin(), size, into.begin());
    from_client.erase(from_client.begin(), from_client.begin() + static_cast<std::ptrdiff_t>(size));
    return size;
  }
  void write(std::span<const std::uint8_t> /*bytes*/) override {}
  std::string address() const override { return "scripted"; }

  void send(const arcos::Frame& frame) {
    from_client.insert(from_client.end(), frame.bytes().begin(), frame.bytes().end());
  }
  std::vector<std::uint8_t> from_client;
};

class RobotServerTest : public testing::Test {
 protected:
  RobotServerTest()
      : robot(fast_exact_settings()),
        server(robot, line, [this](TimeNs, const std::string& what) { events += what + "\n"; }) {
    for (const CommandId id : {CommandId::Sync0, CommandId::Sync1, CommandId::Sync2, CommandId::Open}) {
      line.send(arcos::encode_plain(id));
      run_ms(100);
    }
    line.send(arcos::encode_integer(CommandId::Enable, 1));
    line.send(arcos::encode_integer(CommandId::Vel, 200));
    run_ms(1000);
  }
  void run_ms(int ms) {
    for (int i = 0; i < ms; ++i) server.step(t_ns += kNsPerMs);
  }
  /// The process gets no processor for so long; the client goes on sending, until `silent_ms` before the end.
  void held_up_ms(int ms, int silent_ms) {
    for (int sent_ms = 0; sent_ms < ms - silent_ms; sent_ms += 200)
      line.send(arcos::encode_integer(CommandId::Vel, 200));
    server.step(t_ns += ms * kNsPerMs);
  }

  P3At robot;
  ScriptedLine line;
  std::string events;
  RobotServer server;
  TimeNs t_ns = 0;
};

TEST_F(RobotServerTest, TheRobotDrivesOnWithWhatTheClientSentMeanwhile) {
  ASSERT_NEAR(robot.truth().v_m_s, 0.2, 1e-6);
  for (int i = 0; i < 3; ++i) {
    held_up_ms(1900, 0);
    EXPECT_NEAR(robot.truth().v_m_s, 0.2, 1e-6);
    run_ms(50);
  }
  EXPECT_EQ(events.find("watchdog"), std::string::npos) << events;
}

TEST_F(RobotServerTest, ASilentClientsWatchdogRunsOutAllTheSame) {
  held_up_ms(2500, 2500);
  EXPECT_NE(events.find("watchdog stop"), std::string::npos) << events;
  EXPECT_LT(robot.truth().v_m_s, 0.2);
}

}  // namespace
}  // namespace heel::sim
