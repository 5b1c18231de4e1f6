// Truth and picture agree under a rolling shutter, a rolled mount and bumps of the ground as well.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/scene/marked_world.h"

namespace heel::sim {
namespace {

using test::expect_marks_at_truth;
using test::mark_px;
using test::marked_scenario;
using test::PictureMoment;

TEST(RollingShutter, MarksAreWhereTheTruthSays) {
  Scenario scenario = marked_scenario();
  scenario.camera.readout_ms = 33;
  scenario.camera.mount_pitch_rad = 0.08;
  expect_marks_at_truth(
      scenario,
      {{0.0, {-1.6, 0, 0, 0, 0.8}}, {4.3, {0.2, 0.1, 0.05, 0.5, -0.8}}, {5.1, {0.5, -0.2, 0.1, 0.7, 0.3}}},
      0.4);
}

TEST(RollingShutter, RowsAreSkewedByTheTurn) {
  Scenario scenario = marked_scenario();
  const PictureMoment turning{0.0, {-1.6, 0, 0, 0, 0.8}};
  World global(scenario);
  scenario.camera.readout_ms = 33;
  World rolling(scenario);
  // Marks 0, 1, 2 are the upper row, 6, 7, 8 the lower one. Turning left moves the picture to the right, the
  // more the lower the row: 0.8 rad/s · 33 ms · 554 px = 15 px over the whole height.
  Eigen::Vector2d upper_global, upper_rolling, lower_global, lower_rolling;
  ASSERT_TRUE(mark_px(global, turning, 1, upper_global) && mark_px(rolling, turning, 1, upper_rolling));
  ASSERT_TRUE(mark_px(global, turning, 7, lower_global) && mark_px(rolling, turning, 7, lower_rolling));
  const double skew = (lower_rolling - lower_global).x() - (upper_rolling - upper_global).x();
  const double rows = lower_global.y() - upper_global.y();
  EXPECT_GT(rows, 60);
  EXPECT_NEAR(skew, 0.8 * 0.033 * 554 * rows / 479, 0.3);
}

TEST(Mount, RollAndPitchTurnThePicture) {
  Scenario scenario = marked_scenario();
  scenario.camera.mount_roll_rad = 0.15;
  scenario.camera.mount_pitch_rad = -0.05;
  expect_marks_at_truth(scenario, {{0.0, {-1.6, 0, 0, 0, 0}}, {4.0, {0.0, 0.1, 0.1, 0, 0}}}, 0.35);
  // The camera's right side hangs lower: the upright back leans to the left in the picture. Without folds,
  // because they move the marks to the side.
  scenario.person.cloth_fold_m = 0.0;
  World world(scenario);
  Eigen::Vector2d upper, lower;
  ASSERT_TRUE(mark_px(world, {0.0, {-1.6, 0, 0, 0, 0}}, 1, upper));
  ASSERT_TRUE(mark_px(world, {0.0, {-1.6, 0, 0, 0, 0}}, 7, lower));
  EXPECT_NEAR(std::atan2(upper.x() - lower.x(), lower.y() - upper.y()), -0.15, 0.03);
}

TEST(Ground, BumpsPitchAndRollTheCamera) {
  Scenario scenario = marked_scenario();
  scenario.room.bump_m = 0.004;
  scenario.camera.readout_ms = 15;
  expect_marks_at_truth(
      scenario,
      {{0.0, {-1.61, 0, 0, 0.5, 0}}, {4.3, {0.2, 0.1, 0.05, 0.5, 0.2}}, {4.5, {0.3, 0.15, 0.1, 0.5, 0.2}}},
      0.45);
  const Ground ground(0.004, 7);
  double height2 = 0, pitch2 = 0, roll2 = 0;
  constexpr int kPlaces = 4000;
  for (int i = 0; i < kPlaces; ++i) {
    const double x = 0.037 * i, y = 0.011 * i;
    const GroundPose ground_pose = ground.pose_at(x, y, 0.3);
    height2 += std::pow(ground.height_m(x, y), 2) / kPlaces;
    pitch2 += ground_pose.pitch_rad * ground_pose.pitch_rad / kPlaces;
    roll2 += ground_pose.roll_rad * ground_pose.roll_rad / kPlaces;
  }
  EXPECT_NEAR(std::sqrt(height2), 0.004, 0.0004);
  EXPECT_GT(std::sqrt(pitch2), 0.003);
  EXPECT_LT(std::sqrt(pitch2), 0.03);
  EXPECT_GT(std::sqrt(roll2), 0.003);
  // A slope to the front lifts the nose: the plane through four wheels.
  const GroundPose ground_pose = ground.pose_at(1.0, 2.0, 0.0);
  const double front = ground.height_m(1.125, 2.2) + ground.height_m(1.125, 1.8);
  const double rear = ground.height_m(0.875, 2.2) + ground.height_m(0.875, 1.8);
  EXPECT_NEAR(std::tan(ground_pose.pitch_rad), (front - rear) / 2 / 0.25, 1e-12);
  EXPECT_EQ(Ground(0.0, 7).pose_at(1.0, 2.0, 0.0).pitch_rad, 0.0);
}

TEST(Compression, LosesLittleAtHighQualityAndMoreAtLow) {
  Scenario scenario = marked_scenario();
  scenario.person.shirt = ShirtDesign::Bold;
  std::vector<std::uint8_t> raw, fine, coarse;
  const RobotMotion robot{-1.6, 0, 0, 0, 0};
  World(scenario).render(robot, 0.0, 1, raw);
  scenario.camera.jpeg_quality = 90;
  World(scenario).render(robot, 0.0, 1, fine);
  scenario.camera.jpeg_quality = 20;
  World(scenario).render(robot, 0.0, 1, coarse);
  const auto rms = [&](const std::vector<std::uint8_t>& grey) {
    double sum = 0;
    for (std::size_t i = 0; i < raw.size(); ++i) sum += std::pow(static_cast<double>(grey[i]) - raw[i], 2);
    return std::sqrt(sum / static_cast<double>(raw.size()));
  };
  EXPECT_GT(rms(fine), 0.3);
  EXPECT_LT(rms(fine), 4);
  EXPECT_GT(rms(coarse), 1.5 * rms(fine));
  EXPECT_LT(rms(coarse), 15);
}

}  // namespace
}  // namespace heel::sim
