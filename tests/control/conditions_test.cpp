// Each condition by the input that raises it; hold times of bumper and stall; hysteresis of the target.
#include "control/conditions.h"

#include <gtest/gtest.h>

#include <functional>
#include <utility>

#include "models/robot_models.h"

namespace heel {
namespace {

constexpr TimeNs kFrame_ns = 33 * kNsPerMs;

/// A robot without faults, and the person in every frame.
struct Bench {
  SupervisorConfig config;
  ConditionMonitor monitor;
  ControlInput input;
  bool sonar_on = true;
  bool turns_away = false;

  Bench() {
    input.now_ns = 10 * kNsPerS;
    input.robot.phase = LinkPhase::Running;
    input.robot.has_sip = true;
    input.robot.motors_enabled = true;
    input.has_pose = true;
    input.pose.reason = PoseReason::Found;
    input.pose.certainty = 0.4;
    freshen();
  }
  void freshen() {
    input.robot.odometry.t_ns = input.now_ns;
    input.robot.sonar[3].t_ns = input.now_ns;
    input.pose.t_capture_ns = input.now_ns;
  }
  Conditions frame(MeasurementStatus measurement = MeasurementStatus::Accepted, double certainty = 0.4) {
    input.now_ns += kFrame_ns;
    freshen();
    input.pose.certainty = certainty;
    return update(measurement);
  }
  Conditions idle(TimeNs dt_ns) {  // time passes, and frames come without the person
    input.now_ns += dt_ns;
    freshen();
    return update(MeasurementStatus::NotFound);
  }
  void start_following() {
    for (int i = 0; i < config.frames_to_follow; ++i) frame();
  }
  Conditions same_tick() { return update(MeasurementStatus::None); }
  Conditions update(MeasurementStatus measurement, OperatorCommand command = OperatorCommand::None) {
    return monitor.update(input, measurement, config, robot_models()[0].geometry, sonar_on, command,
                          turns_away);
  }
};

TEST(Conditions, NoneWhileFollowing) {
  Bench bench;
  bench.start_following();
  EXPECT_EQ(bench.frame(), 0U);
}

TEST(Conditions, EachInputRaisesItsOwnBitAlone) {
  struct Row {
    Conditions conditions;
    std::function<void(ControlInput&)> cause;
  };
  const SupervisorConfig config;
  const auto just_over_ns = [](double timeout_s) { return ns_from_seconds(timeout_s) + kNsPerMs; };
  const Row rows[] = {
      {kShutdown, [](ControlInput& in) { in.shutdown = true; }},
      {kLinkDown, [](ControlInput& in) { in.robot.phase = LinkPhase::Lost; }},
      {kLinkDown, [](ControlInput& in) { in.robot.phase = LinkPhase::Closed; }},
      {kLinkDown, [](ControlInput& in) { in.robot.phase = LinkPhase::Syncing; }},
      {kLinkDown, [](ControlInput& in) { in.robot.phase = LinkPhase::Opening; }},
      {kLinkDown, [](ControlInput& in) { in.robot.phase = LinkPhase::Enabling; }},
      {kStaleSip, [](ControlInput& in) { in.robot.has_sip = false; }},
      {kStaleSip, [&](ControlInput& in) { in.robot.odometry.t_ns -= just_over_ns(config.sip_timeout_s); }},
      {kStopButton | kMotorsOff, [](ControlInput& in) { in.robot.stop_button = true; }},
      {kStopButton | kMotorsOff, [](ControlInput& in) { in.robot.e_stall = true; }},
      {kMotorsOff, [](ControlInput& in) { in.robot.motors_enabled = false; }},
      {kBumper, [](ControlInput& in) { in.robot.bumpers_front = 4; }},
      {kBumper, [](ControlInput& in) { in.robot.bumpers_rear = 1; }},
      {kStall, [](ControlInput& in) { in.robot.stall_left = true; }},
      {kStall, [](ControlInput& in) { in.robot.stall_right = true; }},
      {kSonarSilent,
       [&](ControlInput& in) { in.robot.sonar[3].t_ns -= just_over_ns(config.sonar_timeout_s); }},
      {kSonarSilent,
       [](ControlInput& in) { std::swap(in.robot.sonar[3], in.robot.sonar[11]); }},  // rear only
      {kOverrun, [&](ControlInput& in) { in.lateness_ns = just_over_ns(config.lateness_max_s); }},
      {kClockStep, [](ControlInput& in) { in.now_ns -= 1; }},
      {kStaleFrame, [](ControlInput& in) { in.has_pose = false; }},
      {kStaleFrame, [&](ControlInput& in) { in.pose.t_capture_ns -= just_over_ns(config.frame_timeout_s); }},
  };
  for (const Row& row : rows) {
    Bench bench;
    bench.start_following();
    row.cause(bench.input);
    EXPECT_EQ(bench.same_tick(), row.conditions) << &row - rows;
  }
}

TEST(Conditions, MotorsOffAreNotALinkFault) {
  Bench bench;
  bench.start_following();
  bench.input.robot.phase = LinkPhase::Disabled;
  EXPECT_EQ(bench.same_tick(), 0U);
}

TEST(Conditions, SonarsThatAreOffRaiseNothing) {
  Bench bench;
  bench.sonar_on = false;
  bench.start_following();
  bench.input.robot.sonar = {};
  EXPECT_EQ(bench.same_tick(), 0U);
}

TEST(Conditions, TimeoutsAreInclusive) {
  Bench bench;
  bench.start_following();
  bench.input.robot.odometry.t_ns = bench.input.now_ns - ns_from_seconds(bench.config.sip_timeout_s);
  bench.input.pose.t_capture_ns = bench.input.now_ns - ns_from_seconds(bench.config.frame_timeout_s);
  bench.input.robot.sonar[3].t_ns = bench.input.now_ns - ns_from_seconds(bench.config.sonar_timeout_s);
  EXPECT_EQ(bench.same_tick(), 0U);
}

TEST(Conditions, BumperAndStallHoldAfterTheyClear) {
  Bench bench;
  bench.start_following();
  bench.input.robot.bumpers_front = 1;
  bench.input.robot.stall_left = true;
  EXPECT_EQ(bench.frame(), kBumper | kStall);
  bench.input.robot.bumpers_front = 0;
  bench.input.robot.stall_left = false;
  const TimeNs cleared_ns = bench.input.now_ns;
  while (bench.input.now_ns + kFrame_ns <= cleared_ns + ns_from_seconds(bench.config.bumper_hold_s)) {
    ASSERT_EQ(bench.frame(), kBumper | kStall);
  }
  EXPECT_EQ(bench.frame(), 0U);
}

TEST(Conditions, FollowingStartsOnlyAfterEnoughFramesInARow) {
  Bench bench;
  const int enough = bench.config.frames_to_follow;
  ASSERT_GT(enough, 1);
  for (int i = 1; i < enough; ++i) EXPECT_EQ(bench.frame(), kNoTargetYet) << i;
  EXPECT_EQ(bench.frame(MeasurementStatus::NotFound), kNoTargetYet);  // the count starts again
  for (int i = 1; i < enough; ++i) {
    EXPECT_EQ(bench.frame(), kNoTargetYet) << i;
    EXPECT_EQ(bench.same_tick(), kNoTargetYet) << "a tick without a frame does not count";
  }
  EXPECT_EQ(bench.frame(), 0U);
}

TEST(Conditions, FramesFarApartAreNotInARow) {
  Bench bench;
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(bench.frame(), kNoTargetYet);
    bench.input.now_ns += kNsPerS;
    EXPECT_NE(bench.same_tick(), 0U);
  }
}

TEST(Conditions, CertaintyHasHysteresis) {
  Bench bench;
  const double between = 0.5 * (bench.config.certainty_follow + bench.config.certainty_drop);
  for (int i = 0; i < 20; ++i)
    EXPECT_EQ(bench.frame(MeasurementStatus::Accepted, between), kLowCertainty | kNoTargetYet);
  bench.start_following();
  for (int i = 0; i < 100; ++i) EXPECT_EQ(bench.frame(MeasurementStatus::Accepted, between), 0U);
  Conditions last = 0;
  for (int i = 0; i < 100; ++i)
    last = bench.frame(MeasurementStatus::Accepted, 0.5 * bench.config.certainty_drop);
  EXPECT_EQ(last, kLowCertainty | kTargetLost);
  for (int i = 0; i < 20; ++i)
    EXPECT_EQ(bench.frame(MeasurementStatus::Accepted, between), kLowCertainty | kTargetLost);
}

TEST(Conditions, LostAfterTheTimeoutAndFollowedAgainByTheSameRule) {
  Bench bench;
  bench.start_following();
  const TimeNs seen_ns = bench.input.now_ns;
  const TimeNs timeout_ns = ns_from_seconds(bench.config.target_timeout_s);
  EXPECT_EQ(bench.idle(timeout_ns), 0U);
  EXPECT_EQ(bench.input.now_ns - seen_ns, timeout_ns);
  EXPECT_EQ(bench.idle(1), kTargetLost);
  for (int i = 1; i < bench.config.frames_to_follow; ++i) EXPECT_EQ(bench.frame(), kTargetLost) << i;
  EXPECT_EQ(bench.frame(), 0U);
}

TEST(Conditions, MotorsThatWentOffStayOffUntilAReset) {
  Bench bench;
  bench.start_following();
  bench.input.robot.phase = LinkPhase::Disabled;
  bench.input.robot.motors_enabled = false;
  bench.input.robot.stop_button = true;
  EXPECT_EQ(bench.frame(), kStopButton | kMotorsOff);
  EXPECT_EQ(bench.update(MeasurementStatus::None, OperatorCommand::Reset), kStopButton | kMotorsOff);
  bench.input.robot.stop_button = false;
  EXPECT_EQ(bench.frame(), kMotorsOff);
  bench.input.robot.motors_enabled = true;
  EXPECT_EQ(bench.frame(), kMotorsOff) << "they came on by themselves";
  EXPECT_EQ(bench.update(MeasurementStatus::None, OperatorCommand::Start), kMotorsOff);
  EXPECT_EQ(bench.update(MeasurementStatus::None, OperatorCommand::Reset), 0U);
  EXPECT_EQ(bench.frame(), 0U);
}

TEST(Conditions, MotorsThatAreNotEnabledYetNeedNoReset) {
  Bench bench;
  bench.start_following();
  bench.input.robot.phase = LinkPhase::Enabling;
  bench.input.robot.motors_enabled = false;
  EXPECT_EQ(bench.frame(), kLinkDown | kMotorsOff);
  bench.input.robot.phase = LinkPhase::Running;
  bench.input.robot.motors_enabled = true;
  EXPECT_EQ(bench.frame(), 0U);
}

TEST(Conditions, TheBatteryIsLowAfterTwoSecondsAndHasHysteresis) {
  Bench bench;
  const auto low_after = [&bench](double voltage_v, TimeNs time_ns) {
    bench.input.robot.battery_v = voltage_v;
    Conditions last = 0;
    for (const TimeNs end_ns = bench.input.now_ns + time_ns; bench.input.now_ns < end_ns;)
      last = bench.frame();
    return (last & kBatteryLow) != 0;
  };
  bench.start_following();
  const double low_v = bench.config.battery_low_v, ok_v = bench.config.battery_ok_v;
  ASSERT_LT(low_v, ok_v);
  EXPECT_FALSE(low_after(0.0, 5 * kNsPerS)) << "a robot that reports no voltage";
  EXPECT_FALSE(low_after(low_v, 5 * kNsPerS));
  for (int i = 0; i < 5; ++i) {
    EXPECT_FALSE(low_after(low_v - 0.1, 1900 * kNsPerMs)) << "the motors start";
    EXPECT_FALSE(low_after(low_v, kFrame_ns));
  }
  EXPECT_TRUE(low_after(low_v - 0.1, 2100 * kNsPerMs));
  EXPECT_TRUE(low_after(ok_v - 0.1, 5 * kNsPerS)) << "it recovers at rest";
  EXPECT_FALSE(low_after(ok_v, kFrame_ns));
  bench.config.battery_low_v = 0.0;
  EXPECT_FALSE(low_after(1.0, 5 * kNsPerS)) << "not asked for";
}

TEST(Conditions, ALateTickIsAnOverrunAndNoClockStep) {
  Bench bench;
  bench.start_following();
  const TimeNs limit_ns = ns_from_seconds(bench.config.lateness_max_s);
  bench.input.lateness_ns = limit_ns;
  EXPECT_EQ(bench.frame(), 0U) << "inclusive";
  bench.input.lateness_ns = 10 * kNsPerS;
  bench.input.now_ns += 10 * kNsPerS;
  EXPECT_EQ(bench.frame() & (kOverrun | kClockStep), kOverrun);
  bench.input.lateness_ns = 0;
  bench.start_following();
  bench.config.lateness_max_s = 0.0;
  bench.input.lateness_ns = 10 * kNsPerS;
  EXPECT_EQ(bench.frame(), 0U) << "not asked for";
}

TEST(Conditions, TheClockStepsWhenItGoesBackOrFarAhead) {
  Bench bench;
  bench.start_following();
  bench.input.now_ns += 400 * kNsPerMs;
  EXPECT_EQ(bench.frame() & kClockStep, 0U);
  bench.input.now_ns += 600 * kNsPerMs;
  EXPECT_EQ(bench.frame() & kClockStep, kClockStep);
  EXPECT_EQ(bench.frame() & kClockStep, 0U) << "in one tick";
  bench.input.now_ns -= 2 * kFrame_ns;
  EXPECT_EQ(bench.frame() & kClockStep, kClockStep);
  EXPECT_EQ(bench.frame() & kClockStep, 0U);
}

TEST(Conditions, TheOperatorIsAwayWithoutASignForTheTimeout) {
  Bench bench;
  bench.start_following();
  bench.input.t_operator_ns = 1;
  EXPECT_EQ(bench.frame(), 0U) << "not asked for";
  bench.config.operator_timeout_s = 1.0;
  EXPECT_EQ(bench.frame(), kOperatorAway);
  bench.input.t_operator_ns = bench.input.now_ns + kFrame_ns - kNsPerS;
  EXPECT_EQ(bench.frame(), 0U) << "inclusive";
  EXPECT_EQ(bench.frame(), kOperatorAway);
}

TEST(Conditions, AShirtAtTwoPlacesIsAmbiguousOnceTheTargetIsLost) {
  Bench bench;
  bench.start_following();
  bench.input.pose.reason = PoseReason::Ambiguous;
  EXPECT_EQ(bench.frame(MeasurementStatus::NotFound), 0U);
  bench.idle(ns_from_seconds(bench.config.target_timeout_s));
  EXPECT_EQ(bench.frame(MeasurementStatus::NotFound), kAmbiguous | kTargetLost);
  bench.input.pose.reason = PoseReason::TooFewMatches;
  EXPECT_EQ(bench.frame(MeasurementStatus::NotFound), kTargetLost);
}

TEST(Conditions, ATargetNeverFollowedIsNotYetSeenNotLost) {
  Bench bench;
  for (int i = 0; i < 100; ++i) EXPECT_EQ(bench.idle(kFrame_ns) & (kTargetLost | kNoTargetYet), kNoTargetYet);
}

}  // namespace
}  // namespace heel
