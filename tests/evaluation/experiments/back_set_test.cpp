// The test set of backs: which pictures it has, and that a rigid back and a flat board are turned as they
// were told.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "core/angles.h"
#include "evaluation/experiments/back_set_plan.h"
#include "evaluation/experiments/back_set_truth.h"

namespace heel::evaluation {
namespace {

TEST(BackSet, TeachesEveryBuildAndPrintBeforeItAsksForThem) {
  std::set<std::string> images, taught;
  std::map<std::string, int> kinds;
  std::set<std::uint64_t> settlings;
  for (const BackPicture& picture : back_set_stills(1)) {
    EXPECT_TRUE(images.insert(picture.image).second) << picture.image;
    ++kinds[picture.kind];
    const std::string shirt = picture.build + picture.print;
    if (picture.kind == "teach" || picture.image.find("teach") != std::string::npos)
      taught.insert(shirt);
    else
      EXPECT_TRUE(taught.contains(shirt)) << picture.image;
    if (picture.kind == "static" || picture.kind == "calm") {
      EXPECT_NE(picture.posture.settling, sim::kTaughtPosture.settling);
      EXPECT_TRUE(settlings.insert(picture.posture.settling).second)
          << "no cloth settles in the same way twice";
    }
    EXPECT_LE(std::abs(picture.posture.lean_rad), kRadPerDeg * 7.0);
    EXPECT_LE(std::abs(picture.posture.twist_rad), kRadPerDeg * 5.0);
  }
  EXPECT_EQ(kinds["teach"], 12);
  EXPECT_EQ(kinds["static"], 162);
  EXPECT_EQ(kinds["calm"], 45);
  EXPECT_EQ(kinds["rigid"], 45);
  EXPECT_EQ(kinds["board"], 14);
}

TEST(BackSet, TheSameSeedPlansTheSamePictures) {
  const auto a = back_set_stills(3), b = back_set_stills(3), c = back_set_stills(4);
  ASSERT_EQ(a.size(), c.size());
  bool differs = false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].image, b[i].image);
    EXPECT_EQ(a[i].heading_rad, b[i].heading_rad);
    differs = differs || a[i].heading_rad != c[i].heading_rad;
  }
  EXPECT_TRUE(differs);
}

sim::Scenario standing(sim::TorsoShape torso) {
  sim::Scenario scenario;
  scenario.camera.model.width_px = 640;
  scenario.camera.model.height_px = 480;
  scenario.camera.model.fx = scenario.camera.model.fy = 554.0;
  scenario.camera.model.cx = 319.5;
  scenario.camera.model.cy = 239.5;
  scenario.person.torso = torso;
  return scenario;
}

/// The view after the camera has gone to the left round the origin and looks back at it.
Eigen::Isometry3d from_the_left(const Eigen::Isometry3d& view_from_world, double angle_rad) {
  return view_from_world * Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitZ()).inverse();
}

TEST(BackSetTruth, OfARigidBackAndOfABoardIsExact) {
  for (const sim::TorsoShape torso : {sim::TorsoShape::Body, sim::TorsoShape::Board}) {
    const sim::World world(standing(torso), 1, sim::WorldUse::TruthOnly);
    const Eigen::Isometry3d view = world.reference_view_from_world(1.5);
    const sim::PersonPose pose = world.taught_pose();
    const TaughtBack taught =
        taught_back(world, pose, view, {.x_px = 261, .y_px = 112, .width_px = 116, .height_px = 166});
    EXPECT_NEAR(taught.distance_m, 1.5, 0.03);
    const BackTruth square = back_truth(world, pose, view, taught);
    EXPECT_NEAR(square.yaw_deg, 0.0, 1e-9);
    EXPECT_NEAR(square.centre_px.x(), 318.5, 1e-3) << "the middle of the region";
    EXPECT_NEAR(square.centre_px.y(), 194.5, 1e-3);
    const BackTruth turned = back_truth(world, pose, from_the_left(view, 0.4), taught);
    EXPECT_NEAR(turned.yaw_deg, 0.4 / kRadPerDeg, 1e-6);
    EXPECT_NEAR(turned.pitch_deg, 0.0, 1e-6);
    EXPECT_NEAR(turned.roll_deg, 0.0, 1e-6);
    EXPECT_NEAR(turned.fit_rms_mm, 0.0, 1e-6);
    EXPECT_NEAR(turned.yaw_walk_deg, turned.yaw_deg, 1e-6);
  }
}

TEST(BackSetTruth, SaysHowFarTheClothHasMoved) {
  const sim::World world(standing(sim::TorsoShape::Body), 1, sim::WorldUse::TruthOnly);
  const Eigen::Isometry3d view = world.reference_view_from_world(1.5);
  const TaughtBack taught = taught_back(world, world.taught_pose(), view,
                                        {.x_px = 261, .y_px = 112, .width_px = 116, .height_px = 166});
  double most_mm = 0.0;
  for (std::uint64_t settling = 1; settling < 20; ++settling) {
    const BackTruth truth =
        back_truth(world, world.person().pose({}, 0.0, {.settling = settling}), view, taught);
    EXPECT_GT(truth.fit_rms_depth_mm, 1.0);
    EXPECT_LT(truth.fit_rms_depth_mm, 15.0);
    EXPECT_GE(truth.fit_rms_mm, truth.fit_rms_depth_mm);
    most_mm = std::max(most_mm, truth.fit_rms_depth_mm);
  }
  EXPECT_GT(most_mm, 5.0);
}

}  // namespace
}  // namespace heel::evaluation
