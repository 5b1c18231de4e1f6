// Slip and drift: what odometry believes against where the robot is.
#include "sim/robot/chassis.h"

#include <gtest/gtest.h>

#include <cmath>

namespace heel::sim {
namespace {

constexpr double kStep_s = 0.001;

void drive(Chassis& chassis, const WheelSpeeds& wheels, double seconds) {
  for (int i = 0; i < static_cast<int>(std::lround(seconds / kStep_s)); ++i) chassis.drive(wheels, kStep_s);
}

TEST(Chassis, TrueYawIsOdometryYawTimesTheRatioOfTheTracks) {
  for (const double true_track_m : {0.55, 0.588, 0.62, 0.70}) {
    ChassisSettings settings = exact_chassis();
    settings.true_track_m = true_track_m;
    Chassis chassis(settings, 1);
    drive(chassis, {-0.2, 0.2}, 10.0);
    EXPECT_GT(chassis.odometry().heading_rad, 6.0);
    EXPECT_NEAR(chassis.true_pose().heading_rad / chassis.odometry().heading_rad, 0.588 / true_track_m, 1e-9);
  }
}

TEST(Chassis, OdometryTurnsWithTheEffectiveTrack) {
  Chassis chassis(ChassisSettings{}, 1);
  drive(chassis, {0.1, 0.3}, 5.0);
  EXPECT_NEAR(chassis.odometry().heading_rad, (chassis.right_travel_m() - chassis.left_travel_m()) / 0.588,
              1e-9);
}

TEST(Chassis, UnequalWheelsBendAStraightLine) {
  ChassisSettings settings = exact_chassis();
  settings.left_scale_error = -0.002;
  settings.right_scale_error = 0.002;
  settings.true_track_m = 0.62;
  Chassis chassis(settings, 1);
  drive(chassis, {0.5, 0.5}, 20.0);
  const double way_m = chassis.left_travel_m();
  EXPECT_NEAR(way_m, 10.0, 0.05);
  EXPECT_EQ(chassis.odometry().y_m, 0.0);
  const double turn_rad = 0.004 * way_m / 0.62;
  EXPECT_NEAR(chassis.true_pose().heading_rad, turn_rad, 1e-9);
  EXPECT_NEAR(chassis.true_pose().y_m, way_m / turn_rad * (1.0 - std::cos(turn_rad)), 1e-4);
}

TEST(Chassis, DriftIsThreeQuartersOfAPercentAfterOneMetre) {
  ChassisSettings settings = exact_chassis();
  settings.drift_per_sqrt_m = ChassisSettings{}.drift_per_sqrt_m;
  constexpr int kRuns = 400;
  for (const double metres : {1.0, 4.0}) {
    double sum = 0.0, sum_of_squares = 0.0;
    for (int seed = 0; seed < kRuns; ++seed) {
      Chassis chassis(settings, static_cast<std::uint64_t>(seed));
      drive(chassis, {0.5, 0.5}, metres / 0.5);
      const double error_m = chassis.true_pose().x_m - chassis.odometry().x_m;
      sum += error_m;
      sum_of_squares += error_m * error_m;
    }
    const double sigma_m = 0.0075 * std::sqrt(metres);
    EXPECT_NEAR(sum / kRuns, 0.0, 3.5 * sigma_m / std::sqrt(kRuns));
    EXPECT_NEAR(std::sqrt(sum_of_squares / kRuns), sigma_m, 3.5 * sigma_m / std::sqrt(2.0 * kRuns));
  }
}

TEST(Chassis, TheSameSeedDriftsTheSameWay) {
  Chassis a(ChassisSettings{}, 5), b(ChassisSettings{}, 5), c(ChassisSettings{}, 6);
  for (Chassis* chassis : {&a, &b, &c}) drive(*chassis, {0.3, 0.4}, 5.0);
  EXPECT_EQ(a.true_pose().x_m, b.true_pose().x_m);
  EXPECT_EQ(a.true_pose().heading_rad, b.true_pose().heading_rad);
  EXPECT_NE(a.true_pose().x_m, c.true_pose().x_m);
  EXPECT_EQ(a.odometry().x_m, c.odometry().x_m) << "drift must not show in the encoders";
}

TEST(Chassis, StandsStillAtRest) {
  Chassis chassis(ChassisSettings{}, 1);
  drive(chassis, {0.0, 0.0}, 100.0);
  EXPECT_EQ(chassis.true_pose().x_m, 0.0);
  EXPECT_EQ(chassis.true_pose().heading_rad, 0.0);
}

TEST(Chassis, ABlockedWheelTurnsTheRobotAboutItself) {
  Chassis chassis(exact_chassis(), 1);
  chassis.block(true, false);
  drive(chassis, {0.2, 0.2}, 2.0);
  EXPECT_EQ(chassis.left_travel_m(), 0.0);
  EXPECT_NEAR(chassis.true_pose().heading_rad, chassis.right_travel_m() / 0.588, 1e-9);
}

}  // namespace
}  // namespace heel::sim
