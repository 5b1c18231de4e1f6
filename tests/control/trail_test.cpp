// The trail: arc length, smoothing, projection, a trail that crosses itself, people who stand, turn round and
// walk back.
#include "control/trail.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/random.h"
#include "support/allocation_count.h"

namespace heel {
namespace {

constexpr double kSmooth_m = 1.0;
constexpr double kStep_m = 0.017;  // of a frame, at 0.5 m/s
constexpr double kSigma_rad = 0.04;

/// A person who walks, and their trail; the robot is where the trail begins, 2 m behind.
struct Walker {
  Trail trail;
  Pose2 robot{-2.0, 0.0, 0.0};
  Eigen::Vector2d at_m = Eigen::Vector2d::Zero();
  double heading_rad = 0.0;
  double noise_m = 0.0;
  Random random{7};

  bool see() {
    const Eigen::Vector2d seen_m(at_m.x() + noise_m * random.normal(), at_m.y() + noise_m * random.normal());
    return trail.add(seen_m, heading_rad, kSigma_rad, robot);
  }
  void walk(double length_m, double curvature_1_m = 0.0) {
    for (double s = 0.0; s < length_m; s += kStep_m) {
      heading_rad += kStep_m * curvature_1_m;
      at_m += kStep_m * Eigen::Vector2d(std::cos(heading_rad), std::sin(heading_rad));
      see();
    }
  }
};

TEST(Trail, IsAsLongAsTheWalk) {
  Walker person;
  person.see();
  EXPECT_EQ(person.trail.tip_m(), 0.0);
  person.walk(5.0);
  EXPECT_NEAR(person.trail.tip_m(), 5.0, 0.12);  // the first 10 cm may be standing
  const Trail::Place place = person.trail.at(person.trail.tip_m() - 2.0, kSmooth_m);
  EXPECT_NEAR(place.x_m, person.at_m.x() - 2.0, 1e-6);
  EXPECT_NEAR(place.y_m, 0.0, 1e-9);
  EXPECT_NEAR(place.heading_rad, 0.0, 1e-9);
  EXPECT_NEAR(place.curvature_1_m, 0.0, 1e-9);
}

TEST(Trail, DoesNotCutABend) {
  for (const double radius_m : {4.0, 1.5, -2.0}) {
    Walker person;
    person.see();
    person.walk(1.0);
    const Eigen::Vector2d centre_m = person.at_m + Eigen::Vector2d(0.0, radius_m);
    person.walk(4.5, 1.0 / radius_m);
    const Trail::Place place = person.trail.at(person.trail.tip_m() - 2.0, kSmooth_m);
    const double from_centre_m = std::hypot(place.x_m - centre_m.x(), place.y_m - centre_m.y());
    EXPECT_NEAR(from_centre_m, std::abs(radius_m), 0.012) << radius_m;
    EXPECT_NEAR(place.curvature_1_m, 1.0 / radius_m, 0.12 / std::abs(radius_m)) << radius_m;
  }
}

TEST(Trail, SmoothsNoise) {
  Walker person;
  person.noise_m = 0.01;
  person.see();
  person.walk(6.0);
  for (double s = 1.5; s < person.trail.tip_m() - 1.0; s += 0.2) {
    const Trail::Place place = person.trail.at(s, kSmooth_m);
    EXPECT_NEAR(place.y_m, 0.0, 0.01);
    EXPECT_NEAR(place.heading_rad, 0.0, 0.03);
  }
}

TEST(Trail, ProjectsFromWhereTheRobotWasThoughATrailCrossesItself) {
  Walker person;
  person.see();
  person.walk(2.0);
  person.walk(1.5 * std::numbers::pi, 1.0);  // three quarters of a circle to the left
  person.walk(3.0);                          // and over the first part: at x = 1
  const double crossing_m = 1.0;
  const double first_m = person.trail.nearest_m(crossing_m, 0.05, 0.9, 0.3);
  EXPECT_NEAR(first_m, crossing_m, 0.1);
  const double later_m = 2.0 + 1.5 * std::numbers::pi + 1.0;
  EXPECT_NEAR(person.trail.nearest_m(1.0, 0.0, later_m + 0.1, 0.3), later_m, 0.15);
}

TEST(Trail, APersonWhoStandsAddsNothing) {
  Walker person;
  person.see();
  person.walk(3.0);
  const double before_m = person.trail.tip_m();
  person.noise_m = 0.01;
  for (int i = 0; i < 900; ++i) person.see();  // half a minute
  EXPECT_NEAR(person.trail.tip_m(), before_m, 0.1);
}

TEST(Trail, APersonWhoWalksBackTakesItBack) {
  Walker person;
  person.see();
  person.walk(3.0);
  const double before_m = person.trail.tip_m();
  for (int i = 0; i < 60; ++i) {
    person.at_m.x() -= kStep_m;
    person.see();
  }
  EXPECT_NEAR(person.trail.tip_m(), before_m - 60 * kStep_m, 0.1);
  person.walk(1.0);
  EXPECT_NEAR(person.trail.tip_m(), before_m - 60 * kStep_m + 1.0, 0.15);
}

TEST(Trail, APersonWhoTurnsRoundInASmallCircleIsFollowedRound) {
  Walker person;
  person.see();
  person.walk(3.0);
  const double before_m = person.trail.tip_m();
  person.walk(0.4 * std::numbers::pi, 1.0 / 0.4);
  person.walk(2.0);
  EXPECT_NEAR(person.trail.tip_m(), before_m + 0.4 * std::numbers::pi + 2.0, 0.2);
}

TEST(Trail, LeadsInFromTheRobotUnlessThePersonClearlyGoesElsewhere) {
  Walker beside;
  beside.robot = {-2.0, 0.1, 0.0};  // 2.9 degrees: the direction of travel is not known so well
  beside.see();
  EXPECT_NEAR(beside.trail.at(-2.0, kSmooth_m).y_m, 0.1, 0.01);
  Walker across;
  across.robot = {-2.0, 0.8, 0.0};  // 22 degrees
  across.see();
  EXPECT_NEAR(across.trail.at(-2.0, kSmooth_m).y_m, 0.0, 0.03);
}

TEST(Trail, BeginsAgainFarAwayAndBridgesAShortGap) {
  Walker person;
  person.see();
  person.walk(2.0);
  const double before_m = person.trail.tip_m();
  person.at_m.x() += 1.5;  // behind a pole
  EXPECT_TRUE(person.see());
  EXPECT_NEAR(person.trail.tip_m(), before_m + 1.5, 0.05);
  EXPECT_NEAR(person.trail.at(before_m + 0.7, 0.5).x_m, person.at_m.x() - 0.8, 0.05);
  person.at_m.y() += Trail::kLongestGap_m + 0.1;
  EXPECT_FALSE(person.see());
  EXPECT_EQ(person.trail.tip_m(), 0.0);
}

TEST(Trail, ForgetsOnlyTheOldestPartOfALongWalk) {
  Walker person;
  person.see();
  person.walk(40.0);
  EXPECT_NEAR(person.trail.tip_m(), 40.0, 0.3);
  EXPECT_GT(person.trail.first_m(), 15.0);
  EXPECT_NEAR(person.trail.at(person.trail.tip_m() - 2.0, kSmooth_m).x_m, person.at_m.x() - 2.0, 1e-3);
}

TEST(Trail, IgnoresPlacesThatAreNotFinite) {
  Walker person;
  person.see();
  person.walk(1.0);
  const double before_m = person.trail.tip_m();
  person.trail.add({std::nan(""), 0.0}, 0.0, kSigma_rad, person.robot);
  person.trail.add({2.0, 0.0}, std::nan(""), kSigma_rad, person.robot);
  EXPECT_EQ(person.trail.tip_m(), before_m);
}

TEST(Trail, AllocatesNothing) {
  if (!test::counts_allocations()) GTEST_SKIP() << "a sanitizer owns the allocator";
  Walker person;
  const std::uint64_t before = test::allocations_of_this_thread();
  person.see();
  person.walk(30.0, 0.3);
  person.trail.nearest_m(0.0, 0.0, 3.0, kSmooth_m);
  EXPECT_EQ(test::allocations_of_this_thread(), before);
}

}  // namespace
}  // namespace heel
