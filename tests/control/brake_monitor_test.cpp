// A robot that slows down as planned is not seen as slow; one that does not is, after half a second.
#include "control/brake_monitor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace heel {
namespace {

/// A robot with a profile of its own, a delay of commands and a packet each 100 ms.
struct Braking {
  BrakeMonitor monitor;
  RobotState robot;
  VelocityCommand command;
  double v_m_s = 0.7;
  double obeyed_m_s = 0.7;
  TimeNs now_ns = kNsPerS;

  Braking() {
    robot.has_sip = robot.motors_enabled = true;
    command.v_m_s = v_m_s;
  }
  /// The gate takes `commanded_m_s2` off the command, the robot brakes with `true_m_s2`.
  void run(double seconds, double commanded_m_s2, double true_m_s2, double noise_m_s = 0.0) {
    const TimeNs end_ns = now_ns + ns_from_seconds(seconds);
    for (int i = 0; now_ns < end_ns; now_ns += 20 * kNsPerMs, ++i) {
      command.v_m_s = std::max(command.v_m_s - commanded_m_s2 * 0.02, 0.0);
      if (i % 5 == 0) obeyed_m_s = command.v_m_s;  // about 100 ms late
      v_m_s += std::clamp(obeyed_m_s - v_m_s, -true_m_s2 * 0.02, 0.6 * 0.02);
      if (now_ns % (100 * kNsPerMs) == 0) {
        robot.odometry.t_ns = now_ns;
        robot.odometry.v_m_s = v_m_s + noise_m_s * std::sin(static_cast<double>(i));
      }
      monitor.update(robot, command);
    }
  }
};

TEST(BrakeMonitor, SeesNothingWhereTheRobotKeepsUp) {
  for (const double planned_m_s2 : {0.3, 0.75, 1.5}) {
    Braking run;
    run.run(1.0, 0.0, planned_m_s2, 0.02);
    run.run(4.0, planned_m_s2, planned_m_s2, 0.02);
    EXPECT_GE(run.monitor.seen_m_s2(), 0.8 * planned_m_s2) << planned_m_s2;
  }
}

TEST(BrakeMonitor, MeasuresBrakesThatAreWeaker) {
  for (const double true_m_s2 : {0.1, 0.3, 0.5}) {
    Braking run;
    run.run(1.0, 0.0, true_m_s2);
    run.run(1.2, 1.5, true_m_s2);
    EXPECT_NEAR(run.monitor.seen_m_s2(), true_m_s2, 0.15 * true_m_s2);
  }
}

TEST(BrakeMonitor, ARobotThatDoesNotSlowDownHasTheLeastDeceleration) {
  Braking run;
  run.run(2.0, 1.5, 0.0);
  EXPECT_EQ(run.monitor.seen_m_s2(), BrakeMonitor::kLeast_m_s2);
  run.monitor.reset();
  EXPECT_GT(run.monitor.seen_m_s2(), 100.0);
}

TEST(BrakeMonitor, DoesNotMeasureWithTheMotorsOff) {
  Braking run;
  run.robot.motors_enabled = false;
  run.run(2.0, 1.5, 0.2);
  EXPECT_GT(run.monitor.seen_m_s2(), 100.0);
}

/// One packet each 100 ms: the robot's speed, and what it was told.
struct Packets {
  BrakeMonitor monitor;
  RobotState robot;
  TimeNs now_ns = kNsPerS;

  Packets() { robot.has_sip = robot.motors_enabled = true; }
  void add(double v_m_s, double told_m_s) {
    now_ns += 100 * kNsPerMs;
    robot.odometry.t_ns = now_ns;
    robot.odometry.v_m_s = v_m_s;
    VelocityCommand command;
    command.v_m_s = told_m_s;
    monitor.update(robot, command);
  }
};

TEST(BrakeMonitor, MeasuresBackwardsToo) {
  Packets run;
  run.add(-0.7, -0.7);
  for (int i = 0; i < 10; ++i) run.add(-0.7 + 0.03 * i, 0.0);
  EXPECT_NEAR(run.monitor.seen_m_s2(), 0.3, 1e-6);
}

TEST(BrakeMonitor, TheDelayOfASlowLineIsNotWeakness) {
  for (const int delay : {2, 5, 8}) {  // packets from the command until its effect is seen
    Packets run;
    for (int i = 0; i < 5; ++i) run.add(0.7, 0.7);
    for (int i = 0; i < 20; ++i) {
      run.add(std::clamp(0.7 - 0.15 * (i - delay), 0.0, 0.7), 0.0);
      ASSERT_GT(run.monitor.seen_m_s2(), 1.2) << delay << ", packet " << i;
    }
  }
}

TEST(BrakeMonitor, NeitherASlopeNorAPushIsWeakness) {
  Packets slope;
  for (int i = 0; i < 30; ++i) slope.add(0.6, 0.5);
  EXPECT_GT(slope.monitor.seen_m_s2(), 100.0);
  Packets push;
  for (int i = 0; i < 30; ++i) push.add(i < 10 ? 0.05 * i : 0.5, 0.0);
  EXPECT_GT(push.monitor.seen_m_s2(), 100.0);
}

TEST(BrakeMonitor, ALaterStopThatIsStrongerCounts) {
  Packets run;
  const auto stop_with = [&](double m_s2) {
    for (int i = 0; i < 3; ++i) run.add(0.7, 0.7);
    for (int i = 0; i < 30; ++i) run.add(std::max(0.7 - 0.1 * m_s2 * i, 0.0), 0.0);
  };
  stop_with(0.2);
  EXPECT_NEAR(run.monitor.seen_m_s2(), 0.2, 0.02);
  stop_with(1.0);
  EXPECT_NEAR(run.monitor.seen_m_s2(), 1.0, 0.05);
}

}  // namespace
}  // namespace heel
