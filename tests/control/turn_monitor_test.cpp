// Turning towards the person that makes their bearing grow is noticed, whatever the cause; a person who moves
// as people do is no cause.
#include "control/turn_monitor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "control/following.h"
#include "core/random.h"
#include "core/state_sentence.h"

namespace heel {
namespace {

using test::Following;

enum class Wrong { Nothing, Picture, Wheels, Gyro };

/// A loop in which one connection is the wrong way round. The shirt sways, and the camera measures with
/// noise.
struct WrongLoop : Following {
  Wrong wrong = Wrong::Nothing;
  Pose2 believed;  // by the robot's odometry
  Random random;
  double sway_m = 0.02;
  double aside_m_s = 0.0;  // of the person

  WrongLoop(Wrong which, std::uint64_t seed) : wrong(which), random(seed) { person_v_m_s = 0.0; }

  void step() {
    if (input.now_ns % (100 * kNsPerMs) == 0) {
      input.robot.odometry = test::odometry(input.now_ns, believed, v_m_s, record.command.yaw_rate_rad_s);
      input.robot.sonar.fill({input.now_ns, 5.0});
    }
    if (input.now_ns % (40 * kNsPerMs) == 0) {
      Pose2 seen = person;
      const double sway = sway_m * std::sin(5.0 * seconds_from_ns(input.now_ns)) + 0.004 * random.normal();
      seen.x_m -= sway * std::sin(person.heading_rad);
      seen.y_m += sway * std::cos(person.heading_rad);
      if (wrong == Wrong::Picture) seen = test::mirrored_ahead_of(robot, seen);
      const std::uint64_t sequence = input.pose.frame_sequence + 1;
      input.pose = test::measured(seen, robot, mount_of(config.camera), reference);
      input.pose.frame_sequence = sequence;
      input.pose.t_capture_ns = input.now_ns;
      input.has_pose = true;
    }
    record = stage.tick(input);
    v_m_s = record.command.v_m_s;
    const double commanded_rad_s = record.command.yaw_rate_rad_s;
    robot = test::moved(robot, v_m_s, wrong == Wrong::Wheels ? -commanded_rad_s : commanded_rad_s, 0.02);
    believed = test::moved(believed, v_m_s, wrong == Wrong::Gyro ? -commanded_rad_s : commanded_rad_s, 0.02);
    person = test::moved(person, person_v_m_s, person_yaw_rate_rad_s, 0.02);
    person.x_m -= 0.02 * aside_m_s * std::sin(person.heading_rad);
    person.y_m += 0.02 * aside_m_s * std::cos(person.heading_rad);
    input.now_ns += 20 * kNsPerMs;
  }
};

struct Swing {
  double noticed_s = 0.0;  ///< after the robot turned faster than kTurns_rad_s
  double turned_rad = 0.0;
};
constexpr double kTurns_rad_s = 0.2;

/// Until the robot is at rest after a fault, at most 10 s.
Swing swing_of(WrongLoop& run) {
  TimeNs t_turning_ns = 0;
  for (int i = 0; i < 500 && run.record.state != SupervisorState::Stopped; ++i) {
    run.step();
    if (t_turning_ns == 0 && std::abs(run.record.command.yaw_rate_rad_s) > kTurns_rad_s)
      t_turning_ns = run.input.now_ns;
  }
  return {t_turning_ns == 0 ? 0.0 : seconds_from_ns(run.input.now_ns - t_turning_ns),
          std::abs(run.robot.heading_rad)};
}

/// The person stands to one side.
WrongLoop loop_beside(Wrong wrong, std::uint64_t seed) {
  Random random(1000 + seed);
  WrongLoop run(wrong, seed);
  const double side = seed % 2 == 0 ? 1.0 : -1.0;
  run.person = {random.uniform(1.6, 3.0), side * random.uniform(0.35, 0.8), random.uniform(-0.3, 0.3)};
  return run;
}

TEST(TurnMonitor, StopsWithinHalfASecondWhateverMakesTheRobotTurnAway) {
  for (const Wrong wrong : {Wrong::Picture, Wrong::Wheels}) {
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
      SCOPED_TRACE(std::to_string(static_cast<int>(wrong)) + ' ' + std::to_string(seed));
      WrongLoop run = loop_beside(wrong, seed);
      const Swing swing = swing_of(run);
      ASSERT_EQ(run.record.state, SupervisorState::Stopped);
      EXPECT_EQ(run.record.stop_reason, StopReason::TurnsAway);
      EXPECT_LE(swing.noticed_s, 0.5);
      EXPECT_LE(swing.turned_rad, 0.2);
    }
  }
}

/// The robot turns the right way, and where it takes the person to be moves twice as far.
TEST(TurnMonitor, StopsByAGyroThatIsTheWrongWayRoundIfTheRobotTurnsMuch) {
  int stopped = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    WrongLoop run = loop_beside(Wrong::Gyro, seed);
    const Swing swing = swing_of(run);
    if (run.record.state != SupervisorState::Stopped) continue;
    ++stopped;
    EXPECT_EQ(run.record.stop_reason, StopReason::TurnsAway) << seed;
    EXPECT_LE(swing.noticed_s, 0.5) << seed;
  }
  EXPECT_GE(stopped, 35);
}

TEST(TurnMonitor, APersonWhoMovesAsPeopleDoIsNoCause) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    Random random(seed);
    WrongLoop run(Wrong::Nothing, seed);
    double next_s = 0.0;
    const double begin_s = seconds_from_ns(run.input.now_ns);
    while (seconds_from_ns(run.input.now_ns) - begin_s < 60.0) {
      // At any time the person walks on, stands, turns on the spot, or steps aside.
      const double now_s = seconds_from_ns(run.input.now_ns) - begin_s;
      if (now_s >= next_s) {
        next_s = now_s + random.uniform(0.3, 3.0);
        run.person_v_m_s = random.uniform(0.0, 1.0) < 0.3 ? 0.0 : random.uniform(0.0, 1.2);
        run.person_yaw_rate_rad_s = random.uniform(-1.0, 1.0) * (random.uniform(0.0, 1.0) < 0.5 ? 1.5 : 0.3);
        run.aside_m_s = random.uniform() < 0.2 ? random.uniform(-0.6, 0.6) : 0.0;
      }
      run.step();
      ASSERT_NE(run.record.stop_reason, StopReason::TurnsAway) << seed << " after " << now_s << " s";
    }
  }
}

}  // namespace
}  // namespace heel
