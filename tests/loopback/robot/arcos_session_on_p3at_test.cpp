// The session with the simulated P3-AT in lock step and virtual time: every fault of robot and line.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "robot/arcos_session.h"
#include "sim/robot/p3at.h"

namespace heel {
namespace {

using sim::Fault;
using sim::FaultKind;
using Kind = SessionEventKind;

constexpr TimeNs kTick_ns = 20 * kNsPerMs;

sim::P3AtSettings exact_robot() {
  sim::P3AtSettings settings;
  settings.chassis = sim::exact_chassis();
  settings.chassis.true_track_m = 0.588;  // the firmware's value: odometry equals the truth
  return settings;
}

class Bench {
 public:
  explicit Bench(const sim::P3AtSettings& settings = exact_robot(),
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
  int count(Kind kind) const {
    int n = 0;
    for (const Kind one : events) n += one == kind ? 1 : 0;
    return n;
  }
  void inject(FaultKind kind, double duration_s = 0.0, double amount = 0.0) {
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
  std::vector<Kind> events;
  TimeNs now_ns = 0;
  bool running = false;
  double v_m_s = 0.0;
  double yaw_rate_rad_s = 0.0;
};

TEST(ArcosSessionOnP3At, ConnectsAtEveryRateTheRobotMayHave) {
  for (const int baud : kRobotBauds) {
    sim::P3AtSettings settings = exact_robot();
    settings.boot_baud = baud;
    Bench bench(settings);
    bench.start();
    EXPECT_TRUE(bench.run_until(LinkPhase::Running, 15.0)) << baud;
    EXPECT_EQ(bench.count(Kind::ConfigReceived), 1) << baud;
    EXPECT_EQ(bench.session.identity().subclass.view(), "p3at-sh");
  }
}

TEST(ArcosSessionOnP3At, MeanSpeedsAreTheCommandedOnesAt9600Baud) {
  Bench bench;
  bench.start();
  ASSERT_TRUE(bench.run_until(LinkPhase::Running, 5.0));
  bench.v_m_s = 0.2503;
  bench.yaw_rate_rad_s = 0.1234;  // 7.07 deg/s: between two units
  bench.run(2.0);
  const double heading_before = bench.robot.true_pose().heading_rad;
  double path_m = 0.0;
  auto last = bench.robot.true_pose();
  for (int i = 0; i < 1000; ++i) {
    bench.tick();
    const auto now = bench.robot.true_pose();
    path_m += std::hypot(now.x_m - last.x_m, now.y_m - last.y_m);
    last = now;
  }
  EXPECT_NEAR(path_m / 20.0, 0.2503, 0.0005);
  EXPECT_NEAR((last.heading_rad - heading_before) / 20.0, 0.1234, 0.0005);
  bench.v_m_s = bench.yaw_rate_rad_s = 0.0;
  bench.run(2.0);
  bench.expect_odometry_is_truth(0.05);
  EXPECT_EQ(bench.session.state().checksum_errors, 0u);
  EXPECT_LT(bench.robot.input_backlog(), 30u);  // commands do not accumulate on the line
}

TEST(ArcosSessionOnP3At, TheRateOfASlowLineIsRaisedBeforeTheMotorsRun) {
  for (const int wished : {19200, 38400, 57600, 115200}) {
    Bench bench(exact_robot(), ("pty:robot@" + std::to_string(wished)).c_str());
    bench.start();
    for (int i = 0; i < 1000 && bench.robot.baud() == 9600; ++i) {
      bench.tick();
      ASSERT_FALSE(bench.robot.truth().motors_enabled);
    }
    ASSERT_TRUE(bench.run_until(LinkPhase::Running, 1.0)) << wished;
    EXPECT_EQ(bench.robot.baud(), wished);
    EXPECT_EQ(bench.session.wanted_baud(), wished);

    // CLOSE has set the robot's port back: the next session finds it there and raises it again.
    bench.robot.receive(bench.session.close(bench.now_ns), bench.now_ns);
    bench.run(0.1);
    EXPECT_EQ(bench.robot.baud(), 9600);
    bench.session = ArcosSession(bench.config);
    bench.start();
    EXPECT_TRUE(bench.run_until(LinkPhase::Running, 2.5)) << wished;
    EXPECT_EQ(bench.count(Kind::RateRaised), 2);
    EXPECT_EQ(bench.count(Kind::NoAnswer), 0);
  }
}

TEST(ArcosSessionOnP3At, ARobotThatKeepsItsRateAfterCloseIsFoundThere) {
  sim::P3AtSettings settings = exact_robot();
  settings.keeps_rate_after_close = true;
  Bench bench(settings, "pty:robot@57600");
  bench.start();
  ASSERT_TRUE(bench.run_until(LinkPhase::Running, 5.0));
  bench.robot.receive(bench.session.close(bench.now_ns), bench.now_ns);
  bench.run(0.1);
  EXPECT_EQ(bench.robot.baud(), 57600);
  bench.session = ArcosSession(bench.config);
  bench.start();
  EXPECT_TRUE(bench.run_until(LinkPhase::Running, 2.0));
  EXPECT_EQ(bench.count(Kind::RateRaised), 1);
}

TEST(ArcosSessionOnP3At, TheRateOfALossyLineIsRaisedOrTheRobotStaysReachable) {
  for (int seed = 0; seed < 20; ++seed) {
    Bench bench(exact_robot(), "pty:robot");
    bench.inject(FaultKind::GarbleBytes, 0.0, 0.01);
    bench.run(0.02 * seed);
    bench.start();
    EXPECT_TRUE(bench.run_until(LinkPhase::Running, 60.0)) << seed;
    EXPECT_EQ(bench.robot.baud(), bench.session.wanted_baud());
  }
}

TEST(ArcosSessionOnP3At, ANewCommandDoesNotWaitBehindOldOnes) {
  for (const int baud : kRobotBauds) {
    sim::P3AtSettings settings = exact_robot();
    settings.boot_baud = baud;
    Bench bench(settings, ("pty:robot@" + std::to_string(baud)).c_str());
    bench.start();
    ASSERT_TRUE(bench.run_until(LinkPhase::Running, 5.0));
    bench.run(5.0);
    const double byte_ms = 10e3 / baud;
    for (int i = 0; i < 10; ++i) {
      bench.v_m_s = 0.0;
      bench.run(1.0 + 0.02 * i);
      bench.v_m_s = 0.4;
      const TimeNs t_asked_ns = bench.now_ns + kTick_ns;
      bench.tick();
      TimeNs t_ns = t_asked_ns;
      for (; bench.robot.truth().v_m_s == 0.0 && t_ns < t_asked_ns + kNsPerS; t_ns += kNsPerMs) {
        if (t_ns > t_asked_ns && (t_ns - t_asked_ns) % kTick_ns == 0) bench.tick();
        bench.robot.advance(t_ns + kNsPerMs);
      }
      // Its own 9 bytes and RVEL's before it, or at 9600 baud the tick in which RVEL is sent; and two steps
      // of the model.
      const double turn_ms = baud == 9600 ? 20.0 : 9 * byte_ms;
      EXPECT_LE(static_cast<double>(t_ns - t_asked_ns) / kNsPerMs, 9 * byte_ms + turn_ms + 2.0) << baud;
    }
  }
}

TEST(ArcosSessionOnP3At, AnOlderModelWithOtherUnitsIsMeasuredRight) {
  sim::P3AtSettings settings = sim::settings_of_model("p3at");
  settings.chassis = exact_robot().chassis;
  Bench bench(settings);
  bench.start();
  ASSERT_TRUE(bench.run_until(LinkPhase::Running, 5.0));
  bench.v_m_s = 0.5;
  bench.run(40.0);  // 20 m: its counters wrap each 15 m
  bench.v_m_s = 0.0;
  bench.run(2.0);
  EXPECT_GT(bench.session.state().odometry.x_m, 15.0);
  bench.expect_odometry_is_truth(0.05);
}

TEST(ArcosSessionOnP3At, ARobotLeftOpenAndMovingIsStoppedAndDoesNotJump) {
  Bench bench;
  bench.inject(FaultKind::LeftOpen, 0.0, 400.0);
  bench.run(0.1);
  const auto before = bench.robot.true_pose();
  bench.start();
  ASSERT_TRUE(bench.run_until(LinkPhase::Running, 10.0));
  EXPECT_GE(bench.count(Kind::FoundOpen), 1);
  bench.run(2.0);
  const auto after = bench.robot.true_pose();
  // The robot does not move again before the first command.
  EXPECT_LT(std::hypot(after.x_m - before.x_m, after.y_m - before.y_m), 0.20);
  EXPECT_NEAR(bench.robot.truth().v_m_s, 0.0, 1e-6);
}

TEST(ArcosSessionOnP3At, KilledWhileDrivingTheRobotStopsByTheWatchdogAndDoesNotResume) {
  Bench bench;
  bench.start();
  ASSERT_TRUE(bench.run_until(LinkPhase::Running, 5.0));
  bench.v_m_s = 0.5;
  bench.run(3.0);
  ASSERT_GT(bench.robot.truth().v_m_s, 0.45);
  bench.running = false;  // kill -9
  bench.run(2.0 + 0.5);   // the watchdog, and the time to brake at 1.5 m/s²
  ASSERT_NEAR(bench.robot.truth().v_m_s, 0.0, 1e-6);
  const auto stood = bench.robot.true_pose();

  bench.session = ArcosSession(bench.config);
  bench.v_m_s = 0.0;
  bench.start();
  for (const TimeNs end_ns = bench.now_ns + 5 * kNsPerS; bench.now_ns < end_ns;) {
    bench.tick();
    ASSERT_NEAR(bench.robot.true_pose().x_m, stood.x_m, 1e-6) << "the robot moved again";
  }
  EXPECT_EQ(bench.session.state().phase, LinkPhase::Running);
}

TEST(ArcosSessionOnP3At, FollowsOverALossyLine) {
  for (const auto kind : {FaultKind::DropBytes, FaultKind::GarbleBytes}) {
    Bench bench;
    bench.inject(kind, 0.0, 0.005);
    bench.start();
    ASSERT_TRUE(bench.run_until(LinkPhase::Running, 30.0));
    bench.v_m_s = 0.3;
    TimeNs oldest_ns = 0;
    for (int i = 0; i < 3000; ++i) {
      bench.tick();
      oldest_ns = std::max(oldest_ns, bench.now_ns - bench.session.state().odometry.t_ns);
    }
    EXPECT_EQ(bench.session.state().phase, LinkPhase::Running);
    EXPECT_GT(bench.session.state().checksum_errors, 20u);
    EXPECT_GT(bench.session.state().sips, 350u);
    EXPECT_EQ(bench.count(Kind::SipSilence), 0);
    EXPECT_LT(oldest_ns, kNsPerS);
    bench.expect_odometry_is_truth(0.4);  // the pose is as old as the last SIP
  }
}

TEST(ArcosSessionOnP3At, AfterASilenceThePoseIsTheSame) {
  Bench bench;
  bench.start();
  ASSERT_TRUE(bench.run_until(LinkPhase::Running, 5.0));
  bench.v_m_s = 0.4;
  bench.run(5.0);
  bench.v_m_s = 0.0;
  bench.inject(FaultKind::Silence, 4.0);
  ASSERT_TRUE(bench.run_until(LinkPhase::Lost, 3.0));
  ASSERT_TRUE(bench.run_until(LinkPhase::Running, 10.0));
  EXPECT_EQ(bench.session.state().reconnects, 1u);
  bench.run(1.0);
  bench.expect_odometry_is_truth(0.02);
}

TEST(ArcosSessionOnP3At, ControllerResetWhileDriving) {
  Bench bench;
  bench.start();
  ASSERT_TRUE(bench.run_until(LinkPhase::Running, 5.0));
  bench.v_m_s = 0.4;
  bench.run(5.0);
  bench.inject(FaultKind::Reset, 0.0, 255.0);
  bench.v_m_s = 0.0;
  ASSERT_TRUE(bench.run_until(LinkPhase::Syncing, 0.5));
  EXPECT_EQ(bench.count(Kind::ControllerReset), 1);
  ASSERT_TRUE(bench.run_until(LinkPhase::Running, 20.0));
  EXPECT_EQ(bench.count(Kind::OdometryRebased), 1);
  bench.run(1.0);
  // How far it rolled while its counters were set to zero cannot be known.
  bench.expect_odometry_is_truth(0.2);
}

TEST(ArcosSessionOnP3At, StopButtonKeepsTheMotorsOffUntilANewSession) {
  Bench bench;
  bench.start();
  ASSERT_TRUE(bench.run_until(LinkPhase::Running, 5.0));
  bench.v_m_s = 0.4;
  bench.run(2.0);
  bench.robot.press_stop_button(true);
  ASSERT_TRUE(bench.run_until(LinkPhase::Disabled, 0.3));
  bench.run(1.0);
  bench.robot.press_stop_button(false);
  const auto stood = bench.robot.true_pose();
  bench.run(5.0);
  EXPECT_EQ(bench.session.state().phase, LinkPhase::Disabled);
  EXPECT_EQ(bench.robot.true_pose().x_m, stood.x_m);
  bench.robot.receive(bench.session.close(bench.now_ns), bench.now_ns);
  bench.session = ArcosSession(bench.config);
  bench.start();
  ASSERT_TRUE(bench.run_until(LinkPhase::Running, 5.0));
  bench.run(2.0);
  EXPECT_GT(bench.robot.truth().v_m_s, 0.35);
}

TEST(ArcosSessionOnP3At, ConnectsWithoutAConfigWhoseChecksumIsAlwaysWrong) {
  Bench bench;
  bench.inject(FaultKind::BadConfig);
  bench.start();
  EXPECT_TRUE(bench.run_until(LinkPhase::Running, 5.0));
  EXPECT_EQ(bench.count(Kind::ConfigMissing), 1);
}

TEST(ArcosSessionOnP3At, BumpersAndStallsAreReported) {
  Bench bench;
  bench.start();
  ASSERT_TRUE(bench.run_until(LinkPhase::Running, 5.0));
  bench.robot.touch_bumper(0b0000100, 0b0010000);
  bench.run(0.3);
  EXPECT_EQ(bench.session.state().bumpers_front, 0b0000100);
  EXPECT_EQ(bench.session.state().bumpers_rear, 0b0010000);
  bench.robot.touch_bumper(0, 0);
  bench.robot.block_wheels(true, false);
  bench.v_m_s = 0.3;
  bool stalled = false;
  for (int i = 0; i < 200; ++i) {
    bench.tick();
    stalled = stalled || (bench.session.state().stall_left && !bench.session.state().stall_right);
  }
  EXPECT_TRUE(stalled);
}

TEST(ArcosSessionOnP3At, CloseLeavesItClosedAndAtRest) {
  Bench bench;
  bench.start();
  ASSERT_TRUE(bench.run_until(LinkPhase::Running, 5.0));
  bench.v_m_s = 0.4;
  bench.run(2.0);
  bench.robot.receive(bench.session.close(bench.now_ns), bench.now_ns);
  bench.run(1.0);
  EXPECT_EQ(bench.robot.truth().session, sim::Session::Waiting);
  EXPECT_NEAR(bench.robot.truth().v_m_s, 0.0, 1e-6);
  EXPECT_FALSE(bench.robot.truth().motors_enabled);
}

}  // namespace
}  // namespace heel
