// A session and a scripted robot in virtual time, 50 ticks a second.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <deque>
#include <vector>

#include "robot/arcos_session.h"
#include "robot/scripted_robot.h"

namespace heel::test {

inline constexpr TimeNs kTick_ns = 20 * kNsPerMs;

inline RobotConfig bench_config(const char* address = "pty:/dev/pts/0") {
  RobotConfig config;
  config.address = address;
  return config;
}

class SessionBench {
 public:
  explicit SessionBench(const RobotConfig& config = bench_config()) : session(config) {
    session.line_opened(now_ns);
  }

  /// One tick; the robot receives what was written, and its answer is read at the next tick.
  void tick() {
    now_ns += kTick_ns;
    const Bytes sent = robot.speak(now_ns);
    echo(now_ns);
    const bool understood = robot.baud == 0 || robot.baud == session.wanted_baud();
    if (understood && line_up) session.receive(sent, now_ns);
    VelocityCommand command;
    command.t_issued_ns = now_ns;
    command.t_expires_ns = now_ns + command_lifetime_ns;
    command.v_m_s = v_m_s;
    command.yaw_rate_rad_s = yaw_rate_rad_s;
    session.advance(now_ns);
    const int baud = session.wanted_baud();
    const auto before_send = state_bytes();
    const auto bytes = session.send(command, now_ns);
    EXPECT_EQ(state_bytes(), before_send) << "send() must not change the state that the tick used";
    if (line_up) robot.receive(bytes, baud, now_ns);
    for (const std::uint8_t byte : bytes) echoed.push_back({now_ns + echo_after_ns, byte});
    SessionEvent event;
    while (session.next_event(event)) events.push_back(event);
  }

  void run(double seconds) {
    for (TimeNs end_ns = now_ns + ns_from_seconds(seconds); now_ns < end_ns;) tick();
  }
  /// False when the phase does not come within `seconds`.
  bool run_until(LinkPhase phase, double seconds = 20.0) {
    for (TimeNs end_ns = now_ns + ns_from_seconds(seconds); now_ns < end_ns;) {
      tick();
      if (session.state().phase == phase) return true;
    }
    return false;
  }

  int count(SessionEventKind kind) const {
    int n = 0;
    for (const SessionEvent& event : events) n += event.kind == kind ? 1 : 0;
    return n;
  }

  TimeNs now_ns = 1000 * kNsPerS;
  ScriptedRobot robot;
  ArcosSession session;
  std::vector<SessionEvent> events;
  bool line_up = true;
  bool line_echoes = false;       ///< what the session sends comes back, before what the robot says
  TimeNs echo_after_ns = 0;       ///< more than a tick
  std::size_t echo_piece = 1000;  ///< at most so many bytes of it a tick
  double v_m_s = 0.0;
  double yaw_rate_rad_s = 0.0;
  TimeNs command_lifetime_ns = 200 * kNsPerMs;

 private:
  struct EchoedByte {
    TimeNs t_ns = 0;
    std::uint8_t byte = 0;
  };
  void echo(TimeNs t_ns) {
    Bytes due;
    while (line_echoes && !echoed.empty() && due.size() < echo_piece && echoed.front().t_ns <= t_ns) {
      due.push_back(echoed.front().byte);
      echoed.pop_front();
    }
    if (line_up) session.receive(due, t_ns);
  }
  std::deque<EchoedByte> echoed;

  std::array<std::uint8_t, sizeof(RobotState)> state_bytes() const {
    std::array<std::uint8_t, sizeof(RobotState)> bytes{};
    std::memcpy(bytes.data(), &session.state(), bytes.size());
    return bytes;
  }
};

/// A session that drives already.
struct RunningBench : SessionBench {
  explicit RunningBench(const RobotConfig& config = bench_config()) : SessionBench(config) {
    EXPECT_TRUE(run_until(LinkPhase::Running));
    run(0.1);
    robot.log.clear();
  }
  /// heeld ends and is started again.
  void restart() {
    robot.receive(session.close(now_ns), session.wanted_baud(), now_ns);
    session = ArcosSession(bench_config());
    session.line_opened(now_ns);
  }
};

}  // namespace heel::test
