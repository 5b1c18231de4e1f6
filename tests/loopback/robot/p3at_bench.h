// The session with the simulated P3-AT in lock step and virtual time.
#pragma once

#include <gtest/gtest.h>

#include <vector>

#include "robot/arcos_session.h"
#include "sim/robot/p3at.h"

namespace heel::test {

inline constexpr TimeNs kTick_ns = 20 * kNsPerMs;

inline sim::P3AtSettings exact_robot() {
  sim::P3AtSettings settings;
  settings.chassis = sim::exact_chassis();
  settings.chassis.true_track_m = 0.588;  // the firmware's value: odometry equals the truth
  return settings;
}

/// A session and the robot, in lock step.
class P3AtBench {
 public:
  explicit P3AtBench(const sim::P3AtSettings& settings = exact_robot(),
                     const char* address = "serial:/dev/ttyS9@9600")
      : robot(settings, 7), config(make_config(address)), session(config) {}

  static RobotConfig make_config(const char* address) {
    RobotConfig config;
    config.address = address;
    return config;
  }

  /// heeld starts, perhaps after it was killed.
  void start() {
    session.line_opened(now_ns);
    running = true;
  }

  void tick() {
    now_ns += kTick_ns;
    robot.advance(now_ns);
    const auto heard = robot.take_output();
    if (!running) return;
    robot.set_host_baud(session.wanted_baud());
    session.receive(heard, now_ns);
    const VelocityCommand command{now_ns, now_ns + 200 * kNsPerMs, v_m_s, yaw_rate_rad_s, 0};
    session.advance(now_ns);
    robot.receive(session.send(command, now_ns), now_ns);
    SessionEvent event;
    while (session.next_event(event)) events.push_back(event.kind);
  }
  void run(double seconds) {
    for (const TimeNs end_ns = now_ns + ns_from_seconds(seconds); now_ns < end_ns;) tick();
  }
  bool run_until(LinkPhase phase, double seconds) {
    for (const TimeNs end_ns = now_ns + ns_from_seconds(seconds); now_ns < end_ns;) {
      tick();
      if (session.state().phase == phase) return true;
    }
    return false;
  }
  int count(SessionEventKind kind) const {
    int n = 0;
    for (const SessionEventKind one : events) n += one == kind ? 1 : 0;
    return n;
  }
  void inject(sim::FaultKind kind, double duration_s = 0.0, double amount = 0.0) {
    robot.inject({kind, now_ns, ns_from_seconds(duration_s), amount});
  }
  /// Compares odometry with the robot's true pose relative to its start.
  void expect_odometry_is_truth(double tolerance_m) {
    const auto& pose = robot.true_pose();
    EXPECT_NEAR(session.state().odometry.x_m, pose.x_m, tolerance_m);
    EXPECT_NEAR(session.state().odometry.y_m, pose.y_m, tolerance_m);
    EXPECT_NEAR(session.state().odometry.heading_rad, pose.heading_rad, 0.02);
  }

  sim::P3At robot;
  RobotConfig config;
  ArcosSession session;
  std::vector<SessionEventKind> events;
  TimeNs now_ns = 0;
  bool running = false;
  double v_m_s = 0.0;
  double yaw_rate_rad_s = 0.0;
};

}  // namespace heel::test
