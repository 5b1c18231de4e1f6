// Each row of the supervisor's table of conditions, provoked while the robot follows: it is at rest within
// its stated time, and then it needs what the table says.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "control/condition_table.h"
#include "control/following.h"
#include "core/state_sentence.h"

namespace heel {
namespace {

using test::Following;

constexpr double kTwoTicks_s = 0.04;

struct Provocation {
  Condition condition;
  std::function<void(Following&)> cause;
  std::function<void(Following&)> cure;
  /// From the cause to the tick that stops, at most.
  std::function<double(const SupervisorConfig&)> noticed_s = [](const SupervisorConfig&) { return 0.0; };
  /// Without an operator's reset a start is refused by this.
  StopReason needs_reset = StopReason::None;
};

/// In one tick alone.
void ticks_late(Following& run) {
  run.input.lateness_ns = ns_from_seconds(run.config.supervisor.lateness_max_s) + kNsPerMs;
}
void clock_goes_back(Following& run) {
  run.input.now_ns -= 40 * kNsPerMs;
}

constexpr double kBend_s = 1.0;  // until the robot turns
constexpr double kTurnsAwayNoticed_s = 0.5;
void mirrored_in_a_bend(Following& run) {
  run.mirrored = true;
  run.person_yaw_rate_rad_s = 0.6;
}

const std::vector<Provocation>& provocations() {
  using Config = SupervisorConfig;
  static const std::vector<Provocation> rows{
      {kShutdown, [](Following& run) { run.input.shutdown = true; },
       [](Following& run) { run.input.shutdown = false; }},
      {kLinkDown, [](Following& run) { run.input.robot.phase = LinkPhase::Lost; },
       [](Following& run) { run.input.robot.phase = LinkPhase::Running; }},
      {kStaleSip, [](Following& run) { run.packets = false; }, [](Following& run) { run.packets = true; },
       // The last packet came up to 0.1 s before.
       [](const Config& c) { return c.sip_timeout_s; }},
      {kStopButton, [](Following& run) { run.input.robot.stop_button = true; },
       [](Following& run) { run.input.robot.stop_button = false; }, [](const Config&) { return 0.0; },
       StopReason::MotorsOff},
      {kMotorsOff, [](Following& run) { run.input.robot.motors_enabled = false; },
       [](Following& run) { run.input.robot.motors_enabled = true; }, [](const Config&) { return 0.0; },
       StopReason::MotorsOff},
      {kBumper, [](Following& run) { run.input.robot.bumpers_front = 2; },
       [](Following& run) { run.input.robot.bumpers_front = 0; }},
      {kStall, [](Following& run) { run.input.robot.stall_right = true; },
       [](Following& run) { run.input.robot.stall_right = false; }},
      {kOverrun, ticks_late, [](Following& run) { run.input.lateness_ns = 0; }},
      {kClockStep, clock_goes_back, [](Following&) {}},
      {kBatteryLow,
       [](Following& run) { run.input.robot.battery_v = run.config.supervisor.battery_low_v - 0.1; },
       [](Following& run) { run.input.robot.battery_v = run.config.supervisor.battery_ok_v; },
       [](const Config&) { return 2.0; }},
      // The person walks a bend, so that the robot begins to turn.
      {kTurnsAway, mirrored_in_a_bend,
       [](Following& run) {
         run.mirrored = false;
         run.person_yaw_rate_rad_s = 0.0;
       },
       [](const Config&) { return kBend_s + kTurnsAwayNoticed_s; }, StopReason::TurnsAway},
      {kOperatorAway, [](Following& run) { run.operator_there = false; },
       [](Following& run) { run.operator_there = true; },
       [](const Config& c) { return c.operator_timeout_s; }},
      {kSonarSilent, [](Following& run) { run.sonars = false; }, [](Following& run) { run.sonars = true; },
       [](const Config& c) { return c.sonar_timeout_s; }},
      {kStaleFrame, [](Following& run) { run.camera = false; }, [](Following& run) { run.camera = true; },
       [](const Config& c) { return c.frame_timeout_s; }},
      {kAmbiguous, [](Following& run) { run.reason = PoseReason::Ambiguous; },
       [](Following& run) { run.reason = PoseReason::Found; },
       [](const Config& c) { return c.target_timeout_s; }},
      {kLowCertainty, [](Following& run) { run.certainty = 0.5 * run.config.supervisor.certainty_drop; },
       [](Following& run) { run.certainty = 0.4; }, [](const Config& c) { return c.target_timeout_s; }},
      {kTargetLost, [](Following& run) { run.reason = PoseReason::TooFewMatches; },
       [](Following& run) { run.reason = PoseReason::Found; },
       [](const Config& c) { return c.target_timeout_s; }},
  };
  return rows;
}

/// Follows a person who walks at 0.6 m/s, after a start by the operator.
struct Started : Following {
  Started() : Following("view", "operator") {
    config.supervisor.operator_timeout_s = 1.0;
    stage.reconfigure(config);
    person_v_m_s = 0.6;
    run(1.0);
    EXPECT_EQ(v_m_s, 0.0);
    EXPECT_EQ(record.state, SupervisorState::Idle);
    EXPECT_EQ(record.stop_reason, StopReason::NotStarted);
    request(OperatorCommand::Start);
    run(10.0);
    EXPECT_GT(v_m_s, 0.5);
    EXPECT_EQ(record.state, SupervisorState::Following);
    EXPECT_EQ(record.outcome, OperatorOutcome::Done);
  }
  bool drives_within(double seconds) {
    for (const TimeNs end_ns = input.now_ns + ns_from_seconds(seconds); input.now_ns < end_ns && v_m_s < 0.1;)
      tick();
    return v_m_s >= 0.1;
  }
};

TEST(SupervisorInTheLoop, EachConditionBringsTheRobotToRestInItsTime) {
  for (const Provocation& row : provocations()) {
    const ConditionRow& stated = *first_condition(row.condition);
    SCOPED_TRACE(to_string(stated.reason));
    Started run;
    const bool fault = stated.kind == ConditionKind::Fault;
    const double braking_s = fault ? 0.0 : run.braking_s();
    row.cause(run);
    EXPECT_LE(run.until_rest(), row.noticed_s(run.config.supervisor) + braking_s + kTwoTicks_s);
    EXPECT_EQ(run.record.state, fault ? SupervisorState::Stopped : SupervisorState::Waiting);
    EXPECT_EQ(run.record.cause, stated.cause);
    EXPECT_EQ(run.record.stop_reason, stated.reason);
    EXPECT_EQ(state_sentence(run.record).find("at rest: "), 0U) << state_sentence(run.record);

    row.cure(run);
    if (!fault) {
      EXPECT_TRUE(run.drives_within(2.0)) << "it goes on by itself";
      continue;
    }
    EXPECT_FALSE(run.drives_within(run.config.supervisor.bumper_hold_s + 2.0)) << "not without a start";
    if (row.needs_reset != StopReason::None) {
      run.request(OperatorCommand::Start);
      EXPECT_FALSE(run.drives_within(1.0)) << "not without a reset";
      EXPECT_EQ(run.record.outcome, OperatorOutcome::Refused);
      EXPECT_EQ(run.record.refused_by, row.needs_reset);
      run.request(OperatorCommand::Reset);
      run.tick();
      EXPECT_TRUE(run.record.enable_motors);
      EXPECT_FALSE(run.drives_within(1.0)) << "not by the reset";
      EXPECT_EQ(run.record.state, SupervisorState::Idle);
    }
    run.request(OperatorCommand::Start);
    EXPECT_TRUE(run.drives_within(2.0));
    EXPECT_EQ(run.record.outcome, OperatorOutcome::Done);
  }
  EXPECT_EQ(provocations().size() + 1, std::size(kConditionTable)) << "and the target that was never seen";
}

TEST(SupervisorInTheLoop, WithoutATargetTheRobotIsArmedAndDoesNotMove) {
  Following run("view", "operator");
  run.reason = PoseReason::TooFewMatches;
  run.request(OperatorCommand::Start);
  for (int i = 0; i < 250; ++i) {
    run.tick();
    ASSERT_EQ(run.record.state, SupervisorState::Armed);
    ASSERT_EQ(run.record.stop_reason, StopReason::NoTargetYet);
    ASSERT_EQ(run.v_m_s, 0.0);
  }
  EXPECT_EQ(state_sentence(run.record), "at rest: no target seen yet (too few matches)");
}

TEST(SupervisorInTheLoop, AnEmergencyStopCommandsZeroInTheSameTickAndOnlyAResetEndsIt) {
  Started run;
  run.request(OperatorCommand::EStop);
  run.tick();
  EXPECT_EQ(run.v_m_s, 0.0);
  EXPECT_EQ(run.yaw_rate_rad_s, 0.0);
  EXPECT_EQ(run.record.state, SupervisorState::Emergency);
  for (const auto command : {OperatorCommand::Start, OperatorCommand::Stop, OperatorCommand::EStop}) {
    run.request(command);
    EXPECT_FALSE(run.drives_within(1.0));
    EXPECT_EQ(run.record.state, SupervisorState::Emergency);
  }
  run.request(OperatorCommand::Reset);
  EXPECT_FALSE(run.drives_within(1.0));
  EXPECT_EQ(run.record.state, SupervisorState::Idle);
  run.request(OperatorCommand::Start);
  EXPECT_TRUE(run.drives_within(2.0));
}

TEST(SupervisorInTheLoop, AStopBringsTheRobotToRestWithinItsDeceleration) {
  Started run;
  const double v_m_s = run.v_m_s;
  run.request(OperatorCommand::Stop);
  run.tick();
  EXPECT_NEAR(v_m_s - run.v_m_s, run.config.gate.deceleration_m_s2 * 0.02, 1e-9) << "not at once";
  EXPECT_LE(run.until_rest(), run.braking_s());
  EXPECT_FALSE(run.drives_within(5.0));
  EXPECT_EQ(run.record.state, SupervisorState::Idle);
}

TEST(SupervisorInTheLoop, AReconnectionNeedsAStart) {
  Started run;
  run.input.robot.phase = LinkPhase::Lost;
  run.run(1.0);
  ++run.input.robot.reconnects;
  run.input.robot.phase = LinkPhase::Running;
  EXPECT_FALSE(run.drives_within(5.0));
  run.request(OperatorCommand::Start);
  EXPECT_TRUE(run.drives_within(2.0));
}

TEST(SupervisorInTheLoop, ARobotBeforeAnObstacleIsHeldAndSaysSo) {
  Started run;
  const double begin_x_m = run.robot.x_m;
  double moving_hold = 0.0;
  for (const TimeNs end_ns = run.input.now_ns + 10 * kNsPerS; run.input.now_ns < end_ns; run.tick()) {
    run.ahead_m = std::max(1.5 - (run.robot.x_m - begin_x_m), 0.15);
    if (run.record.hold != Hold::None) moving_hold = std::max(moving_hold, run.v_m_s);
  }
  EXPECT_EQ(run.record.state, SupervisorState::Following);
  EXPECT_EQ(run.record.hold, Hold::ObstacleAhead);
  EXPECT_LT(moving_hold, 0.05);
  EXPECT_EQ(state_sentence(run.record).find("held: 0."), 0U) << state_sentence(run.record);
  EXPECT_NE(state_sentence(run.record).find(" m to an echo ahead"), std::string::npos);
  run.ahead_m = 0.0;
  EXPECT_TRUE(run.drives_within(3.0));
  run.run(1.0);
  EXPECT_EQ(state_sentence(run.record), "following");
}

TEST(SupervisorInTheLoop, ARobotNearThePersonIsHeldAndSaysSo) {
  Started run;
  run.person_v_m_s = 0.0;
  run.run(10.0);
  EXPECT_EQ(run.record.hold, Hold::None) << "at the set distance";
  run.config.gate.separation_m = run.record.person_m + 0.1;
  run.stage.reconfigure(run.config);
  run.run(1.0);
  EXPECT_EQ(run.record.hold, Hold::PersonTooNear);
  EXPECT_EQ(state_sentence(run.record).find("held: the person is "), 0U) << state_sentence(run.record);
}

}  // namespace
}  // namespace heel
