// The yaw over the frames of a sequence.
#include "vision/pose/yaw_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "core/angles.h"

namespace heel {
namespace {

constexpr TimeNs kFrame_ns = kNsPerS / 15;

TEST(YawFilter, TakesTheFirstFrameAsItIs) {
  YawFilter filter;
  const FilteredYaw yaw = filter.update(kNsPerS, 0.3, 0.04);
  EXPECT_EQ(yaw.yaw_rad, 0.3);
  EXPECT_EQ(yaw.sigma_rad, 0.04);
}

TEST(YawFilter, ChangesLessFromFrameToFrameThanTheClothDoesAndStatesADeviationThatHolds) {
  double changes = 0.0, cloth_changes = 0.0, nees = 0.0;
  int frames = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    YawFilter filter;
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    const double teaching_rad = 3.0 * kRadPerDeg * normal(random);
    double cloth_rad = 0.0, last_error_rad = 0.0, last_cloth_rad = 0.0;
    for (int i = 0; i < 150; ++i) {
      const double true_rad = 30.0 * kRadPerDeg * std::sin(2.0 * std::numbers::pi * i / 150.0);
      // Correlation 0.6 from one frame to the next, as measured on walking persons.
      cloth_rad = 0.6 * cloth_rad + 0.8 * 4.0 * kRadPerDeg * normal(random);
      const FilteredYaw yaw =
          filter.update(i * kFrame_ns, true_rad + teaching_rad + cloth_rad, 3.0 * kRadPerDeg);
      const double error_rad = yaw.yaw_rad - true_rad;
      if (i >= 15) {
        changes += std::pow(error_rad - last_error_rad, 2);
        cloth_changes += std::pow(cloth_rad - last_cloth_rad, 2);
        nees += std::pow(error_rad / yaw.sigma_rad, 2);
        ++frames;
      }
      last_error_rad = error_rad;
      last_cloth_rad = cloth_rad;
    }
  }
  EXPECT_LT(changes, 0.2 * cloth_changes);
  EXPECT_GT(nees / frames, 0.7);
  EXPECT_LT(nees / frames, 1.5);
}

TEST(YawFilter, FollowsASteadyTurnWithoutDelay) {
  YawFilter filter;
  FilteredYaw yaw;
  for (int i = 0; i <= 45; ++i) yaw = filter.update(i * kFrame_ns, 0.5 * i / 15.0, 0.04);
  EXPECT_NEAR(yaw.yaw_rad, 0.5 * 3.0, 0.01);
}

TEST(YawFilter, GivesOneWildFrameLittleWeight) {
  YawFilter filter;
  for (int i = 0; i < 30; ++i) filter.update(i * kFrame_ns, 0.1, 0.04);
  EXPECT_NEAR(filter.update(30 * kFrame_ns, 1.1, 0.04).yaw_rad, 0.1, 0.1);
}

TEST(YawFilter, StartsAgainAfterAGapAndWhenTimeGoesBack) {
  for (const TimeNs later_ns : {2 * kNsPerS, -kNsPerS}) {
    YawFilter filter;
    for (int i = 0; i < 30; ++i) filter.update(i * kFrame_ns, 0.1, 0.04);
    EXPECT_EQ(filter.update(29 * kFrame_ns + later_ns, -0.7, 0.05).yaw_rad, -0.7);
  }
}

TEST(YawFilter, CrossesTheHalfTurn) {
  YawFilter filter;
  FilteredYaw yaw;
  for (int i = 0; i < 30; ++i)
    yaw = filter.update(i * kFrame_ns, std::remainder(3.1 + 0.01 * i, 2.0 * std::numbers::pi), 0.04);
  EXPECT_NEAR(std::remainder(yaw.yaw_rad - 3.39, 2.0 * std::numbers::pi), 0.0, 0.01);
}

}  // namespace
}  // namespace heel
