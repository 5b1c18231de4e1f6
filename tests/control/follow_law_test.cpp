// What holds for every control law: rest without a target, finite and bounded velocities, no allocation.
#include "control/follow_law.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "control/follow_law_factory.h"
#include "control/law_names.h"
#include "core/random.h"
#include "heel/error.h"
#include "models/robot_models.h"
#include "support/allocation_count.h"

namespace heel {
namespace {

class FollowLawTest : public ::testing::TestWithParam<std::string> {
 protected:
  FollowLawTest() { config_.control.law = GetParam(); }

  WantedVelocity velocity(FollowLaw& law, TargetState target) {
    now_ns_ += 20 * kNsPerMs;
    robot_.odometry.t_ns = now_ns_;
    target.t_capture_ns = now_ns_;
    return law.velocity({now_ns_, target, robot_, obstacles_});
  }
  /// A person seen from the robot, and the goal behind them.
  static TargetState target(double range_m, double bearing_rad, double yaw_rad) {
    constexpr double kBehind_m = 1.65;
    TargetState t;
    t.known = true;
    t.x_m = range_m * std::cos(bearing_rad);
    t.y_m = range_m * std::sin(bearing_rad);
    t.travel_yaw_rad = yaw_rad;
    t.goal_x_m = t.x_m - kBehind_m * std::cos(yaw_rad);
    t.goal_y_m = t.y_m - kBehind_m * std::sin(yaw_rad);
    t.body_odom_x_m = t.x_m;  // the robot stands at the origin of odom
    t.body_odom_y_m = t.y_m;
    return t;
  }
  static TargetState any_target(Random& random) {
    constexpr double kPi = std::numbers::pi;
    return target(random.uniform(0.8, 10.0), random.uniform(-kPi, kPi), random.uniform(-kPi, kPi));
  }

  Config config_;
  RobotState robot_;
  SonarObstacles obstacles_{robot_models()[0].geometry};
  TimeNs now_ns_ = kNsPerS;
};

TEST_P(FollowLawTest, WantsRestWhenTheTargetIsNotKnown) {
  const auto law = make_follow_law(config_);
  velocity(*law, target(4.0, 0.2, 0.3));
  TargetState lost = target(4.0, 0.2, 0.3);
  lost.known = false;
  const WantedVelocity wanted = velocity(*law, lost);
  EXPECT_EQ(wanted.v_m_s, 0.0);
  EXPECT_EQ(wanted.yaw_rate_rad_s, 0.0);
}

TEST_P(FollowLawTest, DrivesTowardsAPersonFarAheadAndTurnsToTheirSide) {
  const auto law = make_follow_law(config_);
  EXPECT_GT(velocity(*law, target(4.0, 0.0, 0.0)).v_m_s, 0.0);
  EXPECT_GT(velocity(*law, target(4.0, 0.2, 0.0)).yaw_rate_rad_s, 0.0);
  law->reset();  // a person cannot be on the other side in the next tick
  EXPECT_LT(velocity(*law, target(4.0, -0.2, 0.0)).yaw_rate_rad_s, 0.0);
}

TEST_P(FollowLawTest, IsBoundedForEveryTarget) {
  const auto law = make_follow_law(config_);
  Random random(17);
  for (int i = 0; i < 20'000; ++i) {
    const TargetState target = any_target(random);
    const WantedVelocity wanted = velocity(*law, target);
    // A law may want more than the gate allows, but within bounds.
    ASSERT_LE(std::abs(wanted.v_m_s), 15.0)
        << target.x_m << " " << target.y_m << " " << target.travel_yaw_rad;
    ASSERT_LE(std::abs(wanted.yaw_rate_rad_s), 35.0)
        << target.x_m << " " << target.y_m << " " << target.travel_yaw_rad;
  }
}

TEST_P(FollowLawTest, IsFiniteForAPersonAtTheCameraBesideItAndVeryFarAway) {
  for (const bool reverse : {false, true}) {
    config_.control.reverse = reverse;
    const auto law = make_follow_law(config_);
    for (const double range_m : {0.0, config_.camera.mount_x_m, 1e-9, 1e6})
      for (const double bearing_rad : {0.0, std::numbers::pi / 2, std::numbers::pi})
        for (const double yaw_rad : {0.0, std::numbers::pi / 2, std::numbers::pi, -std::numbers::pi}) {
          const WantedVelocity wanted = velocity(*law, target(range_m, bearing_rad, yaw_rad));
          EXPECT_TRUE(std::isfinite(wanted.v_m_s)) << range_m << " " << bearing_rad << " " << yaw_rad;
          EXPECT_TRUE(std::isfinite(wanted.yaw_rate_rad_s))
              << range_m << " " << bearing_rad << " " << yaw_rad;
        }
  }
}

TEST_P(FollowLawTest, GivesTheSameForTheSameInputs) {
  const auto one = make_follow_law(config_), other = make_follow_law(config_);
  Random random(5);
  for (int i = 0; i < 1000; ++i) {
    const TargetState target = any_target(random);
    const WantedVelocity a = velocity(*one, target);
    now_ns_ -= 20 * kNsPerMs;
    const WantedVelocity b = velocity(*other, target);
    ASSERT_EQ(a.v_m_s, b.v_m_s);
    ASSERT_EQ(a.yaw_rate_rad_s, b.yaw_rate_rad_s);
  }
}

TEST_P(FollowLawTest, UsesNewGains) {
  const auto law = make_follow_law(config_);
  config_.control.gain_distance_1_s = 0.0;
  law->reconfigure(config_);
  EXPECT_EQ(velocity(*law, target(4.0, 0.0, 0.0)).v_m_s, 0.0);
}

TEST_P(FollowLawTest, AllocatesNothingAfterItIsMade) {
  if (!test::counts_allocations()) GTEST_SKIP() << "a sanitizer owns the allocator";
  const auto law = make_follow_law(config_);
  const std::uint64_t before = test::allocations_of_this_thread();
  Random random(3);
  for (int i = 0; i < 100; ++i) velocity(*law, any_target(random));
  law->reconfigure(config_);
  law->reset();
  velocity(*law, any_target(random));
  EXPECT_EQ(test::allocations_of_this_thread(), before);
}

INSTANTIATE_TEST_SUITE_P(Laws, FollowLawTest, ::testing::ValuesIn(test::law_names()),
                         [](const auto& law) { return law.param; });

TEST(FollowLawFactory, RefusesANameThatIsNoLaw) {
  Config config;
  config.control.law = "views";
  EXPECT_THROW(make_follow_law(config), Error);
}

}  // namespace
}  // namespace heel
