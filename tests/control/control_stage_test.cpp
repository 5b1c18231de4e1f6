// The whole stage in a loop with an exact robot and a perfect camera: it starts within the acceleration
// limit, follows, stops in time for every reason, does not jump after gaps, and does not allocate.
#include "control/control_stage.h"

#include <gtest/gtest.h>

#include <cmath>

#include "control/following.h"
#include "control/law_names.h"
#include "core/angles.h"
#include "core/random.h"
#include "models/robot_models.h"
#include "support/allocation_count.h"
#include "support/decisions.h"

namespace heel {
namespace {

using test::Following;

TEST(ControlStage, WaitsForFramesThenStartsWithinTheAccelerationLimit) {
  Following run;
  run.tick();
  EXPECT_EQ(run.record.stop_reason, StopReason::NoTargetYet);
  EXPECT_EQ(run.v_m_s, 0.0);
  double last_v = 0.0;
  for (int i = 0; i < 100; ++i) {
    run.tick();
    EXPECT_LE(run.v_m_s - last_v, run.config.gate.acceleration_m_s2 * 0.02 + 1e-12);
    last_v = run.v_m_s;
  }
  EXPECT_EQ(run.record.stop_reason, StopReason::None);
  EXPECT_GT(run.v_m_s, 0.2);
}

TEST(ControlStage, TheRecordHoldsTheInputAndTheStatusOfThePose) {
  Following run;
  run.tick();
  EXPECT_EQ(run.record.input.now_ns, 5 * kNsPerS);
  EXPECT_EQ(run.record.input.pose.frame_sequence, 1u);
  EXPECT_EQ(run.record.input.robot.sonar[3].t_ns, 5 * kNsPerS);
  EXPECT_EQ(run.record.measurement, MeasurementStatus::Accepted);
  EXPECT_EQ(run.record.conditions, kNoTargetYet);
  EXPECT_EQ(run.record.wanted.t_issued_ns, 5 * kNsPerS);
  EXPECT_EQ(run.record.wanted.t_expires_ns,
            5 * kNsPerS + ns_from_seconds(run.config.gate.command_lifetime_s));
  run.tick();
  EXPECT_EQ(run.record.input.pose.frame_sequence, 1u);
  EXPECT_EQ(run.record.measurement, MeasurementStatus::None);
  run.visible = false;
  run.tick();
  EXPECT_EQ(run.record.input.pose.frame_sequence, 2u);
  EXPECT_EQ(run.record.measurement, MeasurementStatus::NotFound);
}

TEST(ControlStage, FollowsAWalkingPersonRoundABend) {
  Following run;
  run.run(10.0);
  run.person_yaw_rate_rad_s = 0.25;
  double worst_bearing_rad = 0.0;
  for (int i = 0; i < 300; ++i) {
    run.tick();
    worst_bearing_rad =
        std::max(worst_bearing_rad, std::abs(std::atan2(run.record.target.y_m, run.record.target.x_m)));
  }
  run.person_yaw_rate_rad_s = 0.0;
  run.run(20.0);
  EXPECT_EQ(run.record.stop_reason, StopReason::None);
  EXPECT_LT(worst_bearing_rad, run.config.control.bearing_max_rad + 0.05);
  EXPECT_NEAR(run.v_m_s, 0.5, 0.02);
  EXPECT_NEAR(wrap_angle_rad(run.robot.heading_rad - run.person.heading_rad), 0.0, 0.03);
}

TEST(ControlStage, ComesToRestInTimeWhenTheTargetIsLost) {
  Following run;
  run.person_v_m_s = 0.7;
  run.run(10.0);
  ASSERT_GT(run.v_m_s, 0.6);
  run.visible = false;
  EXPECT_LE(run.until_rest(), run.config.supervisor.target_timeout_s + run.braking_s() + 0.08);
  EXPECT_EQ(run.record.stop_reason, StopReason::TargetLost);
}

TEST(ControlStage, ComesToRestInTimeWhenTheCameraIsLost) {
  Following run;
  run.person_v_m_s = 0.7;
  run.run(10.0);
  run.camera = false;
  EXPECT_LE(run.until_rest(), run.config.supervisor.frame_timeout_s + run.braking_s() + 0.08);
  EXPECT_EQ(run.record.stop_reason, StopReason::StaleFrame);
}

TEST(ControlStage, FaultsOfTheRobotStopAtOnceAndTheRobotResumesFromZero) {
  Following run;
  run.run(10.0);
  ASSERT_GT(run.v_m_s, 0.3);
  run.input.robot.bumpers_front = 1;
  run.tick();
  EXPECT_EQ(run.record.stop_reason, StopReason::Bumper);
  EXPECT_EQ(run.v_m_s, 0.0);
  run.input.robot.bumpers_front = 0;
  run.run(run.config.supervisor.bumper_hold_s - 0.1);
  EXPECT_EQ(run.v_m_s, 0.0);
  double last_v = 0.0;
  for (int i = 0; i < 50; ++i) {
    run.tick();
    EXPECT_LE(run.v_m_s - last_v, run.config.gate.acceleration_m_s2 * 0.02 + 1e-12);
    last_v = run.v_m_s;
  }
  EXPECT_GT(last_v, 0.2);
}

TEST(ControlStage, StopsBeforeAnObstacle) {
  Following run;
  run.run(10.0);
  ASSERT_GT(run.v_m_s, 0.4);
  const Pose2 begin = run.robot;
  for (const TimeNs end_ns = run.input.now_ns + 10 * kNsPerS; run.input.now_ns < end_ns; run.tick())
    run.ahead_m = std::max(1.5 - (run.robot.x_m - begin.x_m), 0.15);
  EXPECT_EQ(run.v_m_s, 0.0);
  EXPECT_EQ(run.record.stop_reason, StopReason::None);
  EXPECT_TRUE(run.record.command.limited_by & kGateObstacle);
  // The sonar sits 68 mm behind the bumper and looks 10° to the side.
  EXPECT_NEAR(run.ahead_m * std::cos(0.1745) - 0.068, run.config.gate.clearance_m, 0.07);
}

TEST(ControlStage, SomebodyWhoComesIsExpectedToComeOnButNotTheFollowedPerson) {
  // The echo is 10° to the side of a sonar that sits 68 mm behind the bumper: at 1.5 m and 2 m beside the
  // way.
  const auto with_echo = [](double before_person_m) {
    Following run;
    run.person.x_m = 2.3;
    run.person_v_m_s = 0.0;
    run.run(1.0);
    run.ahead_m = run.record.target.x_m - before_person_m - 0.25;
    run.run(0.1);  // the sonars are read once
    EXPECT_GT(run.v_m_s, 0.0);
    return run;
  };
  EXPECT_EQ(with_echo(0.0).record.free_distance_m, std::numeric_limits<double>::infinity());
  const Following somebody = with_echo(0.5);
  const double echo_m = somebody.ahead_m * std::cos(10 * kRadPerDeg) - 0.068;
  EXPECT_NEAR(echo_m - somebody.record.free_distance_m, 0.75, 0.1);
}

TEST(ControlStage, UsesTheOutlineAndSonarsOfTheRobotThatAnswers) {
  const auto free_m = [](const char* subclass) {
    Following run;
    run.input.robot.kind.choice = ModelChoice::Chosen;
    run.input.robot.kind.model = static_cast<std::uint8_t>(index_of_model(subclass).value());
    run.ahead_m = 1.0;
    run.run(3.0);
    return run.record.free_distance_m;
  };
  // Sonar 3 of each, and its bumper: P3-AT (245, 10°) and 313 mm, P3-DX (166, 10°) and 210 mm.
  const double p3at_m = free_m("p3at-sh");
  EXPECT_NEAR(p3at_m, 0.245 + std::cos(0.1745) - 0.313, 0.06) << "it drives between two readings";
  EXPECT_NEAR(free_m("p3dx") - p3at_m, (0.166 - 0.210) - (0.245 - 0.313), 1e-9);
  // A PowerBot's sonar 3 looks 35° to the side, beyond its own half width of 340 mm and the margin.
  EXPECT_EQ(free_m("powerbot-sh"), std::numeric_limits<double>::infinity());
}

TEST(ControlStage, ARefusedRobotKeepsTheShapeOfTheLastOne) {
  Following run;
  run.input.robot.kind.choice = ModelChoice::Conflict;
  run.input.robot.kind.model = static_cast<std::uint8_t>(index_of_model("powerbot-sh").value());
  run.ahead_m = 1.0;
  run.run(3.0);
  EXPECT_NEAR(run.record.free_distance_m, 0.245 + std::cos(0.1745) - 0.313, 0.06);
}

TEST(ControlStage, PlansItsStopsWithTheBrakesThatTheControllerAllows) {
  Following run;
  run.input.robot.limits.deceleration_m_s2 = 0.3;
  run.tick();
  EXPECT_EQ(run.record.planned_deceleration_m_s2, 0.3);
  run.input.robot.limits.deceleration_m_s2 = 5.0;
  run.tick();
  EXPECT_EQ(run.record.planned_deceleration_m_s2, run.config.gate.deceleration_m_s2);
}

TEST(ControlStage, RestsWhenTheSonarsAreSilentUnlessTheyAreOff) {
  for (const bool sonar : {true, false}) {
    Following run;
    run.config.robot.sonar = sonar;
    run.stage.reconfigure(run.config);
    run.run(10.0);
    ASSERT_GT(run.v_m_s, 0.4);
    for (int i = 0; i < 100; ++i) {
      run.tick();
      run.input.robot.sonar.fill({7 * kNsPerS, 0.2});  // near, but too old to count
    }
    EXPECT_EQ(run.record.stop_reason, sonar ? StopReason::SonarSilent : StopReason::None);
    EXPECT_EQ(run.v_m_s == 0.0, sonar);
  }
}

TEST(ControlStage, ShutdownCommandsZero) {
  Following run;
  run.run(5.0);
  run.input.shutdown = true;
  run.tick();
  EXPECT_EQ(run.record.stop_reason, StopReason::Shutdown);
  EXPECT_EQ(run.v_m_s, 0.0);
}

TEST(ControlStage, AfterAGapInTheTicksTheFirstCommandIsZero) {
  Following run;
  run.run(5.0);
  ASSERT_GT(run.v_m_s, 0.3);
  run.input.now_ns += kNsPerS;
  run.tick();
  EXPECT_EQ(run.v_m_s, 0.0);
  EXPECT_EQ(run.yaw_rate_rad_s, 0.0);
}

TEST(ControlStage, AReconnectionDiscardsTheTarget) {
  Following run;
  run.run(2.0);
  ASSERT_TRUE(run.record.target.known);
  run.camera = false;
  ++run.input.robot.reconnects;
  run.tick();
  EXPECT_FALSE(run.record.target.known);
}

TEST(ControlStage, AReconnectionDiscardsTheSonarObstacles) {
  Following run;
  run.run(2.0);
  run.ahead_m = 1.0;
  run.run(0.08);
  ASSERT_TRUE(std::isfinite(run.record.free_distance_m));
  ASSERT_NE(run.input.now_ns % (100 * kNsPerMs), 0) << "the sonars must not be read in this tick";
  ++run.input.robot.reconnects;
  run.tick();
  EXPECT_FALSE(std::isfinite(run.record.free_distance_m)) << run.record.free_distance_m;
}

TEST(ControlStage, ReconfigureKeepsTheTargetAndTheSpeed) {
  Following run;
  run.run(5.0);
  const double before = run.v_m_s;
  run.config.gate.v_max_m_s = 0.2;
  run.stage.reconfigure(run.config);
  run.tick();
  EXPECT_EQ(run.record.stop_reason, StopReason::None);
  // A speed above the new limit counts as the limit from this tick on.
  EXPECT_LT(run.v_m_s, before);
  EXPECT_LE(run.v_m_s, 0.2);
  EXPECT_GT(run.v_m_s, 0.1);
}

TEST(ControlStage, TheSameInputsGiveTheSameCommands) {
  Following a, b;
  a.person.y_m = b.person.y_m = 0.3;
  test::DecisionCounts counts;
  for (int i = 0; i < 500; ++i) {
    a.tick();
    b.tick();
    ASSERT_EQ(test::decision_bytes(a.record), test::decision_bytes(b.record)) << i;
    counts.add(a.record);
  }
  EXPECT_GT(counts.moving, 400);
}

TEST(ControlStage, ReconfigureDoesNotChangeTheLaw) {
  Following run, unchanged;
  run.config.control.law = "position";
  run.stage.reconfigure(run.config);
  run.person_yaw_rate_rad_s = unchanged.person_yaw_rate_rad_s = 0.2;
  for (int i = 0; i < 250; ++i) {
    run.tick();
    unchanged.tick();
    ASSERT_EQ(run.yaw_rate_rad_s, unchanged.yaw_rate_rad_s);
  }
  EXPECT_NE(run.yaw_rate_rad_s, 0.0);
}

class ControlStageWithEachLaw : public ::testing::TestWithParam<std::string> {};

TEST_P(ControlStageWithEachLaw, FollowsAPersonWhoWalksStraight) {
  Following run(GetParam());
  run.robot = {0.0, 0.4, 0.1};
  run.run(40.0);
  EXPECT_EQ(run.record.stop_reason, StopReason::None);
  EXPECT_NEAR(run.v_m_s, 0.5, 0.02);
  EXPECT_NEAR(run.robot.y_m, 0.0, 0.05);
  run.visible = false;
  run.run(2.0);
  const bool searches = run.record.state == SupervisorState::Searching;
  EXPECT_EQ(searches, GetParam() == "trail");
  if (searches) {
    EXPECT_LE(run.v_m_s, run.config.control.search_m_s);
    run.run(run.config.supervisor.search_s);
  }
  EXPECT_EQ(run.record.state, SupervisorState::Waiting);
  EXPECT_EQ(run.v_m_s, 0.0);
  EXPECT_EQ(run.yaw_rate_rad_s, 0.0);
}

/// A person who jumps from place to place every 0.8 s and is sometimes not found.
TEST_P(ControlStageWithEachLaw, CommandsStayWithinTheLimitsOfTheGate) {
  Following run(GetParam());
  run.config.estimate.outliers_to_reset = 2;  // the estimate follows the jumps
  run.stage.reconfigure(run.config);
  const GateConfig& limits = run.config.gate;
  Random random(29);
  double last_v_m_s = 0.0;
  int moving = 0;
  for (int i = 0; i < 20'000; ++i) {
    if (i % 40 == 0) {
      const double range_m = random.uniform(0.3, 6.0), bearing_rad = random.uniform(-0.5, 0.5);
      run.person = test::moved(run.robot, 0.0, bearing_rad, 1.0);
      run.person = test::moved(run.person, range_m, 0.0, 1.0);
      run.person.heading_rad += random.uniform(-1.2, 1.2);
      run.visible = random.uniform() < 0.9;
    }
    run.tick();
    ASSERT_LE(std::abs(run.v_m_s), limits.v_max_m_s);
    ASSERT_LE(std::abs(run.yaw_rate_rad_s), limits.yaw_rate_max_rad_s);
    ASSERT_LE(run.v_m_s - last_v_m_s, limits.acceleration_m_s2 * 0.02 + 1e-12);
    ASSERT_TRUE(std::isfinite(run.record.wanted.v_m_s) && std::isfinite(run.record.wanted.yaw_rate_rad_s));
    last_v_m_s = run.v_m_s;
    moving += run.v_m_s > 0.0;
  }
  EXPECT_GT(moving, 1000);
}

TEST_P(ControlStageWithEachLaw, TickDoesNotAllocate) {
  Following run(GetParam());
  if (!test::counts_allocations()) GTEST_SKIP() << "a sanitizer owns the allocator";
  const std::uint64_t before = test::allocations_of_this_thread();
  run.run(3.0);
  run.stage.reconfigure(run.config);
  run.run(1.0);
  EXPECT_EQ(test::allocations_of_this_thread(), before);
  EXPECT_GT(before, 0u);
}

INSTANTIATE_TEST_SUITE_P(Laws, ControlStageWithEachLaw, ::testing::ValuesIn(test::law_names()),
                         [](const auto& law) { return law.param; });

}  // namespace
}  // namespace heel
