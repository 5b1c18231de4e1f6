// Experiments with still images: the rendered person is where it was commanded, and the shirt is found there.
#include "evaluation/experiments/still_image_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <set>

#include "evaluation/experiments/occluding_board.h"
#include "evaluation/experiments/still_image_cases.h"
#include "heel/error.h"
#include "sim/lockstep/lockstep.h"

namespace heel::evaluation {
namespace {

sim::Scenario small_base() {
  sim::Scenario base;
  base.camera.model = sim::default_camera_model();
  base.room.objects = 5;
  return base;
}

TEST(StillImageScene, TheRobotIsPlacedSoThatTheBackIsInTheCommandedPose) {
  sim::Scenario base = small_base();
  base.camera.mount_y_m = 0.07;
  sim::World world(still_image_scenario(base, {}));
  const sim::Truth person = world.truth({}, 0.0);
  for (const StillImageView& view :
       {StillImageView{.x_m = 0.0, .z_m = 2.0}, StillImageView{.x_m = -0.7, .z_m = 1.4, .yaw_rad = 0.9},
        StillImageView{.x_m = 0.4, .z_m = 5.0, .yaw_rad = -1.3}}) {
    const sim::Truth truth = world.truth(robot_for(base.camera, person, view), 0.0);
    EXPECT_NEAR(truth.back_in_camera_m.x(), view.x_m, 1e-9);
    EXPECT_NEAR(truth.back_in_camera_m.z(), view.z_m, 1e-9);
    EXPECT_NEAR(truth.yaw_rad, view.yaw_rad, 1e-9);
  }
}

TEST(StillImageScene, BlurIsTheCommandedLengthInTheMiddleOfThePicture) {
  const sim::Scenario base = small_base();
  const sim::RobotMotion robot = robot_for(base.camera, {}, {.z_m = 2.0, .blur_px = 6.0});
  const double turned_rad = robot.yaw_rate_rad_s * 1e-3 * base.camera.sensor.exposure_ms;
  EXPECT_NEAR(base.camera.model.fx * turned_rad, 6.0, 1e-9);
}

TEST(StillImageScene, TheShirtIsFoundAndTrackedNearTheTruth) {
  const sim::Scenario base = small_base();
  const ShirtTemplate shirt = sim::teach_from_world(still_image_scenario(base, {}), 1.5);
  StillImageScene scene(base, {}, shirt, VisionConfig{});
  const auto rows = scene.estimate_pair("near", {.x_m = 0.2, .z_m = 1.8, .yaw_rad = 0.2});
  EXPECT_FALSE(rows[0].pose.tracked) << "there was no earlier frame";
  EXPECT_TRUE(rows[1].pose.tracked);
  for (const StillImageRow& row : rows) {
    ASSERT_TRUE(row.pose.found()) << to_string(row.pose.reason);
    EXPECT_NEAR(row.pose.yaw_rad, row.true_yaw_rad, 0.1);
    EXPECT_NEAR(row.pose.position_m[0], row.true_x_m, 0.02);
    EXPECT_NEAR(row.pose.position_m[2], row.true_z_m, 0.05);
    // t follows from R: the yaw's error, times the template's distance, is the sideways error.
    EXPECT_NEAR(row.t_m[0] - row.true_t_m.x(), -1.5 * (row.pose.yaw_rad - row.true_yaw_rad), 0.03);
    EXPECT_NEAR(row.t_m[2], row.true_t_m.z(), 0.06);
  }
  // The second pose is far from the first: the whole frame is searched, not only the last place.
  EXPECT_FALSE(scene.estimate_pair("elsewhere", {.x_m = -0.4, .z_m = 2.0})[0].pose.tracked);
}

TEST(OccludingBoard, HidesTheCommandedShareOfTheBack) {
  const CameraModel camera = sim::default_camera_model();
  sim::Truth truth;
  truth.back_in_camera_m = {0.0, 0.0, 2.0};
  truth.back_px = {320.0, 240.0};
  const double half_px = camera.fx * kBackHalfWidth_m / 2.0;
  const auto covered = [&](double share) {
    std::vector<std::uint8_t> grey(640 * 480, 0);
    draw_occluding_board(truth, camera, share, 5, 1.0, grey);
    int hidden = 0;
    const int first = static_cast<int>(std::lround(320 - half_px)),
              last = static_cast<int>(std::lround(320 + half_px));
    for (int x = first; x < last; ++x) hidden += grey[240UL * 640 + static_cast<std::size_t>(x)] > 0;
    return hidden / static_cast<double>(last - first);
  };
  EXPECT_NEAR(covered(0.3), 0.3, 0.02);
  EXPECT_NEAR(covered(-0.6), 0.6, 0.02);
  EXPECT_NEAR(covered(1.0), 1.0, 0.02);
}

TEST(StillImageCases, CoverTheConditionsTheyAreNamedAfter) {
  ASSERT_GE(still_image_experiments().size(), 4U);
  for (const StillImageExperiment& experiment : still_image_experiments()) {
    const auto cases = experiment.cases(experiment.repeats);
    EXPECT_GE(cases.size(), 12U) << experiment.name;
    std::set<std::uint64_t> seeds;
    for (const StillImageCase& one : cases) {
      seeds.insert(one.world.seed);
      EXPECT_EQ(one.name.find(','), std::string::npos) << "names are cells of a CSV file";
      EXPECT_NO_THROW(sim::shirt_design(one.world.shirt));
      EXPECT_LT(std::hypot(one.view.x_m, one.view.z_m), 6.1);
    }
    EXPECT_EQ(seeds.size(), static_cast<std::size_t>(kMaxWorlds)) << experiment.name;
  }
}

}  // namespace
}  // namespace heel::evaluation
