// The gate: what it passes unchanged, and the limits that hold for every input.
#include "control/gate.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <limits>

#include "models/robot_models.h"

namespace heel {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr TimeNs kNow_ns = 100 * kNsPerS;
constexpr TimeNs kTick_ns = 20 * kNsPerMs;
constexpr double kTick_s = 0.02;
const GateConfig kLimits;  // the defaults

VelocityCommand command(double v_m_s, double yaw_rate_rad_s, TimeNs t_issued_ns = kNow_ns) {
  return {t_issued_ns, t_issued_ns + 200 * kNsPerMs, v_m_s, yaw_rate_rad_s, 0};
}

/// No obstacle is near; the person is `person_m` from the camera.
Clearances free_space(double person_m = kInf) {
  return {person_m, SonarObstacles(robot_models()[0].geometry)};
}

Clearances obstacle(double x_m, double y_m) {
  Clearances clearances = free_space();
  clearances.obstacles.add({x_m, y_m});
  return clearances;
}

VelocityCommand pass(const VelocityCommand& wanted, const VelocityCommand& previous,
                     StopStyle style = StopStyle::Go, const Clearances& clearances = free_space()) {
  return apply_gate(wanted, previous, style, clearances, kNow_ns, GateConfig{}).command;
}

TEST(Gate, PassesACommandWithinTheLimitsUnchanged) {
  const auto out = pass(command(0.305, 0.31), command(0.3, 0.3, kNow_ns - kTick_ns));
  EXPECT_DOUBLE_EQ(out.v_m_s, 0.305);
  EXPECT_DOUBLE_EQ(out.yaw_rate_rad_s, 0.31);
  EXPECT_EQ(out.limited_by, 0);
}

TEST(Gate, NamesWhatHoldsTheRobot) {
  const auto hold = [](double wanted_m_s, double now_m_s, const Clearances& clearances,
                       StopStyle style = StopStyle::Go) {
    return apply_gate(command(wanted_m_s, 0), command(now_m_s, 0, kNow_ns - kTick_ns), style, clearances,
                      kNow_ns, GateConfig{})
        .hold;
  };
  const double bumper_m = robot_models()[0].geometry.front_m, near_m = bumper_m + kLimits.clearance_m;
  const Clearances near_person = free_space(kLimits.separation_m - 0.05);
  EXPECT_EQ(hold(0.5, 0.0, free_space()), Hold::None);
  EXPECT_EQ(hold(0.0, 0.0, free_space()), Hold::None) << "the law wants to stand";
  EXPECT_EQ(hold(0.5, 0.0, near_person), Hold::PersonTooNear);
  EXPECT_EQ(hold(0.0, 0.0, near_person), Hold::PersonTooNear) << "the law wants to stand, and must";
  EXPECT_EQ(hold(-0.5, -0.4, near_person), Hold::None) << "it gives way";
  EXPECT_EQ(hold(0.5, 0.5, near_person), Hold::None) << "it still brakes";
  EXPECT_EQ(hold(0.5, 0.0, free_space(kLimits.separation_m + 0.3)), Hold::None) << "slower, not held";
  EXPECT_EQ(hold(0.5, 0.0, near_person, StopStyle::ComeToRest), Hold::None) << "the supervisor stops it";
  EXPECT_EQ(hold(0.5, 0.0, near_person, StopStyle::AtOnce), Hold::None);
  EXPECT_EQ(hold(0.5, 0.0, obstacle(near_m - 0.05, 0.0)), Hold::ObstacleAhead);
  EXPECT_EQ(hold(0.5, 0.5, obstacle(near_m - 0.05, 0.0)), Hold::None) << "it still brakes";
  EXPECT_EQ(hold(0.5, 0.0, obstacle(near_m + 0.5, 0.0)), Hold::None) << "slower, not held";
  EXPECT_EQ(hold(0.0, 0.0, obstacle(near_m - 0.05, 0.0)), Hold::None) << "the law wants to stand";
}

TEST(Gate, StopsForSomebodyWhoComesFromTheSideAndPassesAPoleThere) {
  const auto passed_m_s = [](double reach_m) {
    Clearances clearances = free_space();
    clearances.obstacles.add({1.2, 0.8, reach_m});
    return pass(command(0.5, 0.0), command(0.5, 0.0, kNow_ns - kTick_ns), StopStyle::Go, clearances);
  };
  EXPECT_EQ(passed_m_s(0.0).v_m_s, 0.5);
  EXPECT_NEAR(passed_m_s(0.9).v_m_s, 0.5 - kLimits.deceleration_m_s2 * kTick_s, 1e-9);
  EXPECT_NE(passed_m_s(0.9).limited_by & kGateObstacle, 0);
}

TEST(Gate, DrivesPastAPostThatIsOnlyInWhatIsKeptFreeBesideTheRobot) {
  const double near_m = robot_models()[0].geometry.front_m + 0.2;
  const auto slowed = [&](double y_m) {
    return pass(command(0.2, 0.0), command(0.2, 0.0, kNow_ns - kTick_ns), StopStyle::Go,
                obstacle(near_m, y_m))
               .v_m_s < 0.2;
  };
  EXPECT_TRUE(slowed(0.2));
  EXPECT_FALSE(slowed(0.31));
}

TEST(Gate, LimitsTheSpeedAndSetsTheBit) {
  const double v_m_s = kLimits.v_max_m_s, yaw_rate_rad_s = -kLimits.yaw_rate_max_rad_s;
  const auto out = pass(command(9, -9), command(v_m_s, yaw_rate_rad_s, kNow_ns - kTick_ns));
  EXPECT_DOUBLE_EQ(out.v_m_s, v_m_s);
  EXPECT_DOUBLE_EQ(out.yaw_rate_rad_s, yaw_rate_rad_s);
  EXPECT_EQ(out.limited_by, kGateSpeed);
}

TEST(Gate, SlewsFromThePresentCommand) {
  const auto out =
      pass(command(kLimits.v_max_m_s, kLimits.yaw_rate_max_rad_s), command(0.1, 0.0, kNow_ns - kTick_ns));
  EXPECT_NEAR(out.v_m_s, 0.1 + kLimits.acceleration_m_s2 * kTick_s, 1e-12);
  EXPECT_NEAR(out.yaw_rate_rad_s, kLimits.yaw_acceleration_rad_s2 * kTick_s, 1e-12);
  EXPECT_EQ(out.limited_by, kGateAcceleration);
}

TEST(Gate, ReversalStopsAtZeroFirst) {
  EXPECT_EQ(pass(command(-0.5, 0), command(0.01, 0, kNow_ns - kTick_ns)).v_m_s, 0.0);
  EXPECT_NEAR(pass(command(-0.5, 0), command(0.0, 0, kNow_ns - kTick_ns)).v_m_s,
              -kLimits.acceleration_m_s2 * kTick_s, 1e-12);
}

TEST(Gate, FirstCommandAndFirstAfterAGapAreZero) {
  EXPECT_EQ(pass(command(0.7, 1.0), VelocityCommand{}).v_m_s, 0.0);
  const auto out = pass(command(0.7, 1.0), command(0.5, 0.5, kNow_ns - kNsPerS));
  EXPECT_EQ(out.v_m_s, 0.0);
  EXPECT_EQ(out.yaw_rate_rad_s, 0.0);
}

TEST(Gate, ComesToRestWithinTheDeceleration) {
  VelocityCommand last = command(kLimits.v_max_m_s, -kLimits.yaw_rate_max_rad_s, kNow_ns);
  TimeNs now_ns = kNow_ns;
  while (last.v_m_s != 0.0 || last.yaw_rate_rad_s != 0.0) {
    now_ns += kTick_ns;
    const auto next = apply_gate(command(0.7, -1.0, now_ns), last, StopStyle::ComeToRest, free_space(),
                                 now_ns, GateConfig{})
                          .command;
    ASSERT_LE(last.v_m_s - next.v_m_s, kLimits.deceleration_m_s2 * kTick_s + 1e-12);
    last = next;
  }
  const double longest_s = std::max(kLimits.v_max_m_s / kLimits.deceleration_m_s2,
                                    kLimits.yaw_rate_max_rad_s / kLimits.yaw_acceleration_rad_s2);
  EXPECT_LE(seconds_from_ns(now_ns - kNow_ns), longest_s + kTick_s);
}

TEST(Gate, AtOnceGivesZeroInTheSameTick) {
  const auto out = pass(command(0.7, 1.0), command(0.7, 1.0, kNow_ns - kTick_ns), StopStyle::AtOnce);
  EXPECT_EQ(out.v_m_s, 0.0);
  EXPECT_EQ(out.yaw_rate_rad_s, 0.0);
  EXPECT_GT(out.t_expires_ns, kNow_ns);
}

TEST(Gate, OldAndNotFiniteCommandsCountAsRestAndSetTheBit) {
  const auto previous = command(0.7, 1.0, kNow_ns - kTick_ns);
  const auto old = pass(command(0.7, 1.0, kNow_ns - kNsPerS), previous);
  EXPECT_LT(old.v_m_s, 0.7);
  EXPECT_TRUE(old.limited_by & kGateAge);
  for (const auto& bad : {command(kNaN, 0), command(0, kNaN), command(kInf, 0), command(0, -kInf)}) {
    const auto out = pass(bad, previous);
    EXPECT_LT(out.v_m_s, 0.7);
    EXPECT_LT(out.yaw_rate_rad_s, 1.0);
    EXPECT_TRUE(out.limited_by & kGateNotFinite);
  }
}

TEST(Gate, StopsShortOfTheSeparation) {
  const GateConfig limits;
  double range_m = 3.0;
  VelocityCommand last = command(0, 0, kNow_ns);
  TimeNs now_ns = kNow_ns;
  for (int i = 0; i < 2000; ++i) {
    now_ns += kTick_ns;
    last =
        apply_gate(command(0.7, 0, now_ns), last, StopStyle::Go, free_space(range_m), now_ns, limits).command;
    range_m -= last.v_m_s * 0.02;
  }
  EXPECT_GE(range_m, limits.separation_m - 1e-3);
  EXPECT_LT(range_m, limits.separation_m + 0.1);
  EXPECT_TRUE(last.limited_by & kGateSeparation);
  // An unknown range (NaN) permits no motion.
  EXPECT_EQ(pass(command(0.5, 0), command(0.0, 0, kNow_ns - kTick_ns), StopStyle::Go, free_space(kNaN)).v_m_s,
            0.0);
  // Backing away is still allowed.
  EXPECT_LT(pass(command(-0.5, 0), command(0, 0, kNow_ns - kTick_ns), StopStyle::Go, free_space(0.3)).v_m_s,
            0.0);
}

TEST(Gate, PlansItsStopsWithTheBrakesOfTheRobot) {
  for (const double brakes_m_s2 : {0.1, 0.3, 1.0}) {
    Clearances ahead = free_space(2.0);
    ahead.deceleration_m_s2 = brakes_m_s2;
    const VelocityCommand last = command(0.7, 0, kNow_ns - kTick_ns);
    VelocityCommand now = pass(command(0.7, 0), last, StopStyle::Go, ahead);
    for (int i = 0; i < 100; ++i)
      now = pass(command(0.7, 0), {kNow_ns - kTick_ns, kNow_ns + kTick_ns, now.v_m_s, 0, 0}, StopStyle::Go,
                 ahead);
    // Half of it is left when the robot brakes from this speed to the distance of separation.
    EXPECT_LE(now.v_m_s * now.v_m_s, brakes_m_s2 * (2.0 - GateConfig{}.separation_m) + 1e-9);
    EXPECT_GT(now.v_m_s, 0.3);
  }
  for (const double unknown : {kNaN, 0.0, -1.0}) {
    Clearances ahead = free_space();
    ahead.deceleration_m_s2 = unknown;
    EXPECT_EQ(pass(command(0.5, 0), command(0, 0, kNow_ns - kTick_ns), StopStyle::Go, ahead).v_m_s, 0.0);
  }
}

/// A law that turns while its speed only begins to grow: the arc of some centimetres is not what it will
/// drive.
TEST(Gate, AnObstacleAheadHoldsARobotThatOnlyBeginsToMove) {
  for (const double v_m_s : {0.004, 0.02, 0.1}) {
    const auto result = apply_gate(command(v_m_s, 0.3), command(0, 0, kNow_ns - kTick_ns), StopStyle::Go,
                                   obstacle(0.313 + 0.3, 0.1), kNow_ns, GateConfig{});
    EXPECT_EQ(result.command.v_m_s, 0.0) << v_m_s;
    EXPECT_EQ(result.hold, Hold::ObstacleAhead) << v_m_s;
  }
}

TEST(Gate, ReturnsTheFreeDistanceItUsed) {
  const auto free_distance_m = [](StopStyle style, const Clearances& clearances) {
    return apply_gate(command(0.5, 0), command(0.5, 0, kNow_ns - kTick_ns), style, clearances, kNow_ns,
                      GateConfig{})
        .free_distance_m;
  };
  EXPECT_EQ(free_distance_m(StopStyle::Go, free_space()), kInf);
  const Clearances ahead = obstacle(0.313 + 1.25, 0.1);
  EXPECT_NEAR(free_distance_m(StopStyle::Go, ahead), 1.25, 1e-12);
  EXPECT_NEAR(free_distance_m(StopStyle::ComeToRest, ahead), 1.25, 1e-12);
  EXPECT_TRUE(std::isnan(free_distance_m(StopStyle::AtOnce, ahead)));
}

TEST(Gate, StopsShortOfASonarObstacle) {
  const GateConfig limits;
  double obstacle_m = 3.0;  // ahead of the bumper
  VelocityCommand last = command(0, 0, kNow_ns);
  TimeNs now_ns = kNow_ns;
  const auto step = [&](double v_m_s) {
    now_ns += kTick_ns;
    const Clearances ahead = obstacle(0.313 + obstacle_m, 0.1);
    last = apply_gate(command(v_m_s, 0, now_ns), last, StopStyle::Go, ahead, now_ns, limits).command;
    obstacle_m -= last.v_m_s * 0.02;
  };
  for (int i = 0; i < 2000; ++i) step(0.7);
  EXPECT_GE(obstacle_m, limits.clearance_m - 1e-3);
  EXPECT_LT(obstacle_m, limits.clearance_m + 0.1);
  EXPECT_TRUE(last.limited_by & kGateObstacle);
  for (int i = 0; i < 100; ++i) step(-0.5);  // backing away is still allowed
  EXPECT_GT(obstacle_m, limits.clearance_m + 0.3);
}

TEST(Gate, BrakesForObstaclesOnThePresentAndOnTheCommandedPath) {
  const Clearances left = obstacle(0.7, 0.45);  // on an arc to the left, not straight ahead
  const Clearances right = obstacle(0.7, -0.45);
  const auto turning = command(0.6, 0.9, kNow_ns - kTick_ns);
  EXPECT_LT(pass(command(0.6, 0), turning, StopStyle::Go, left).v_m_s, 0.6);
  EXPECT_EQ(pass(command(0.6, 0), turning, StopStyle::Go, right).v_m_s, 0.6);
  const auto straight = command(0.6, 0, kNow_ns - kTick_ns);
  EXPECT_LT(pass(command(0.6, 0.9), straight, StopStyle::Go, left).v_m_s, 0.6);
  EXPECT_EQ(pass(command(0.6, 0.9), straight, StopStyle::Go, right).v_m_s, 0.6);
}

double any_double() {
  const auto special = rc::gen::element(kNaN, kInf, -kInf, 0.0, -0.0, 1e308, -1e308, 5e-324);
  return *rc::gen::oneOf(special, rc::gen::arbitrary<double>(),
                         rc::gen::map(rc::gen::inRange(-2000, 2000), [](int i) { return i * 1e-3; }));
}

TimeNs any_time() {
  return kNow_ns + *rc::gen::oneOf(rc::gen::inRange<TimeNs>(-500 * kNsPerMs, 500 * kNsPerMs),
                                   rc::gen::inRange<TimeNs>(-kNow_ns, kNow_ns));
}

VelocityCommand any_command() {
  return {any_time(), any_time(), any_double(), any_double(), *rc::gen::arbitrary<std::uint8_t>()};
}

Clearances any_clearances() {
  Clearances clearances = free_space(any_double());
  clearances.deceleration_m_s2 = any_double();
  for (std::size_t i = *rc::gen::inRange<std::size_t>(0, kMaxSonars + 1); i > 0; --i)
    clearances.obstacles.add({any_double(), any_double()});
  return clearances;
}

RC_GTEST_PROP(GateProperty, NothingEverExceedsALimitAndEverythingExpires, ()) {
  const GateConfig limits;
  const VelocityCommand wanted = any_command();
  const VelocityCommand previous = any_command();
  const auto style = *rc::gen::element(StopStyle::Go, StopStyle::ComeToRest, StopStyle::AtOnce);
  const auto out = apply_gate(wanted, previous, style, any_clearances(), kNow_ns, limits).command;

  RC_ASSERT(std::isfinite(out.v_m_s) && std::isfinite(out.yaw_rate_rad_s));
  RC_ASSERT(std::abs(out.v_m_s) <= limits.v_max_m_s);
  RC_ASSERT(std::abs(out.yaw_rate_rad_s) <= limits.yaw_rate_max_rad_s);
  RC_ASSERT(out.t_issued_ns == kNow_ns);
  RC_ASSERT(out.t_expires_ns == kNow_ns + ns_from_seconds(limits.command_lifetime_s));
  if (style == StopStyle::AtOnce) RC_ASSERT(out.v_m_s == 0.0 && out.yaw_rate_rad_s == 0.0);
}

RC_GTEST_PROP(GateProperty, NoStepIsLargerThanTheAccelerationsAllow, ()) {
  const GateConfig limits;
  VelocityCommand last = command(0, 0, kNow_ns);
  TimeNs now_ns = kNow_ns;
  for (int i = 0; i < 50; ++i) {
    now_ns += *rc::gen::inRange<TimeNs>(1, 150 * kNsPerMs);
    const double dt_s =
        std::min(seconds_from_ns(now_ns - last.t_issued_ns), seconds_from_ns(kLongestSlew_ns));
    VelocityCommand wanted = any_command();
    wanted.t_expires_ns = now_ns + 1;
    const auto out = apply_gate(wanted, last, *rc::gen::element(StopStyle::Go, StopStyle::ComeToRest),
                                any_clearances(), now_ns, limits)
                         .command;
    const double gain = std::abs(out.v_m_s) - std::abs(last.v_m_s);
    RC_ASSERT(gain <= limits.acceleration_m_s2 * dt_s + 1e-12);
    RC_ASSERT(-gain <= limits.deceleration_m_s2 * dt_s + 1e-12);
    RC_ASSERT(out.v_m_s * last.v_m_s >= 0.0);  // no change of sign in one step
    RC_ASSERT(std::abs(out.yaw_rate_rad_s - last.yaw_rate_rad_s) <=
              limits.yaw_acceleration_rad_s2 * dt_s + 1e-12);
    last = out;
  }
}

}  // namespace
}  // namespace heel
