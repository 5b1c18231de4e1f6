// The world's truth agrees with its pictures: a known point is found at the pixel the camera model says,
// under distortion, tilt, gait and sliding cloth; and the same seed gives the same picture to the bit.
#include <gtest/gtest.h>

#include <cmath>

#include "heel/error.h"
#include "sim/scene/marked_world.h"
#include "sim/scene/shirts.h"
#include "sim/scene/world.h"

namespace heel::sim {
namespace {

using test::bright_centre;
using test::expect_marks_at_truth;
using test::marked_scenario;

TEST(WorldTruth, MarksAreWhereTheCameraModelSays) {
  Scenario scenario = marked_scenario();
  expect_marks_at_truth(
      scenario, {{0.0, {-1.6, 0, 0, 0, 0}}, {4.3, {0.2, 0.1, 0.05, 0, 0}}, {5.1, {0.5, -0.2, 0.1, 0, 0}}},
      0.35);
}

TEST(WorldTruth, UnderStrongDistortionAndTilt) {
  Scenario scenario = marked_scenario();
  scenario.camera.model.k1 = -0.3;
  scenario.camera.model.k2 = 0.1;
  scenario.camera.model.p1 = 0.003;
  scenario.camera.mount_pitch_rad = 0.12;
  // The back is in the corners of the picture, where distortion is largest.
  expect_marks_at_truth(
      scenario, {{0.0, {-1.7, 0, 0.3, 0, 0}}, {0.0, {-1.7, 0, -0.3, 0, 0}}, {4.0, {0.0, 0.0, 0.25, 0, 0}}},
      0.4);
}

TEST(WorldTruth, BackDirectionAndPositionInTheCamera) {
  Scenario scenario = marked_scenario();
  scenario.person.cloth_fold_m = 0.0;
  World world(scenario);
  // Person at the origin facing +x; the camera 2 m behind, 0.15 m ahead of the robot.
  const Truth straight = world.truth({-2.0 - 0.15, 0, 0, 0, 0}, 0.0);
  EXPECT_NEAR(straight.yaw_rad, 0.0, 1e-9);
  EXPECT_NEAR(straight.back_in_camera_m.x(), 0.0, 1e-9);
  EXPECT_NEAR(straight.back_in_camera_m.z(), 2.0 + world.person().back_centre_m().x(), 1e-9);
  EXPECT_NEAR(straight.back_in_camera_m.y(), 1.1 - straight.back_m.z(), 1e-9);
  EXPECT_TRUE(straight.in_view);
  // The robot turned left by 0.2 rad: the person walks to the image's right.
  const Truth turned = world.truth({-2.15, 0, 0.2, 0, 0}, 0.0);
  EXPECT_NEAR(turned.yaw_rad, 0.2, 1e-9);
  EXPECT_GT(turned.back_in_camera_m.x(), 0.2);
  EXPECT_FALSE(world.truth({-2.15, 0, 3.0, 0, 0}, 0.0).in_view);
  // From in front one does not see a back.
  EXPECT_FALSE(world.truth({2.15, 0, 3.14159, 0, 0}, 0.0).in_view);
}

TEST(WorldPicture, SameSeedSamePictureToTheBit) {
  Scenario scenario;
  scenario.camera.model = default_camera_model();
  World a(scenario);
  World b(scenario);
  scenario.seed = 2;
  World c(scenario);
  std::vector<std::uint8_t> pa, pb, pc;
  const RobotMotion robot{-1.7, 0, 0.02, 0.4, 0.3};
  b.render({-3, 1, 1, 0, 0}, 1.0, 3, pb);  // what was drawn before must not matter
  a.render(robot, 0.5, 7, pa);
  b.render(robot, 0.5, 7, pb);
  c.render(robot, 0.5, 7, pc);
  EXPECT_EQ(pa, pb);
  EXPECT_NE(pa, pc);
  a.render(robot, 0.5, 8, pb);
  EXPECT_NE(pa, pb);  // the noise is another frame's
}

TEST(WorldPicture, EveryPixelIsCovered) {
  Scenario scenario = marked_scenario();
  scenario.camera.sensor.read_noise_grey = 0;
  scenario.camera.sensor.shot_noise_grey = 0;
  scenario.camera.sensor.gain = 1.0;
  scenario.light.level = 0.02;  // everything that is lit is nearly black; a hole would show
  World world(scenario);
  std::vector<std::uint8_t> grey;
  for (double heading = 0; heading < 6.3; heading += 0.7) {
    world.render({-1.0, 0.5, heading, 0, 0}, 0.0, 0, grey);
    for (const std::uint8_t pixel : grey) ASSERT_LT(pixel, 30) << heading;
  }
}

TEST(WorldPicture, MotionBlursAlongTheMotion) {
  Scenario scenario = marked_scenario();
  scenario.camera.sensor.exposure_ms = 20;
  World world(scenario);
  std::vector<std::uint8_t> still, turning;
  world.render({-1.7, 0, 0, 0, 0}, 0.0, 0, still);
  world.render({-1.7, 0, 0, 0, 0.8}, 0.0, 0, turning);  // 0.8 rad/s · 20 ms · 554 px: 9 px to the side
  const auto energy = [](const std::vector<std::uint8_t>& grey, int step) {
    double sum = 0;
    for (std::size_t i = 640 * 100 + 1; i < 640 * 380; ++i) {
      const double d = static_cast<double>(grey[i + static_cast<std::size_t>(step)]) - grey[i];
      sum += d * d;
    }
    return sum;
  };
  EXPECT_LT(energy(turning, 1), 0.5 * energy(still, 1));      // sideways gradients go
  EXPECT_GT(energy(turning, 640), 0.3 * energy(still, 640));  // upright ones mostly stay
}

TEST(ReferenceView, IsSquareToTheBack) {
  Scenario scenario = marked_scenario();
  scenario.person.cloth_fold_m = 0.0;
  World world(scenario);
  const ReferenceView view = world.reference_view(1.5);
  EXPECT_EQ(view.grey.size(), 640U * 480U);
  EXPECT_GT(view.roi.width_px, 90);
  EXPECT_GT(view.roi.height_px, 140);
  // The mark in the middle of the back lies where a level camera at that distance has it.
  const ShirtMark mark = shirt_mark(4);
  const Eigen::Vector3d point = world.person().shirt_point_m(mark.s_texel, mark.t_texel);
  const Eigen::Vector3d centre = world.person().back_centre_m();
  const Truth truth = world.truth({}, 0.0);
  const Eigen::Vector2d px = world.project_px(
      {-(point.y() - centre.y()), scenario.camera.mount_z_m - (truth.back_m.z() - centre.z() + point.z()),
       1.5 + point.x() - centre.x()});
  EXPECT_LT((bright_centre(view.grey, 640, px) - px).norm(), 0.35);
  EXPECT_THROW(world.reference_view(0.5), Error);
}

}  // namespace
}  // namespace heel::sim
