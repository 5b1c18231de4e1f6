// Other people, obstacles, lines of sight, windows.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "sim/scene/world.h"

namespace heel::sim {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

Scenario empty_room() {
  Scenario scenario;
  scenario.camera.model = default_camera_model();
  scenario.room.objects = 0;
  return scenario;
}

ObstacleSettings pole(double x_m, double y_m) {
  ObstacleSettings out;
  out.kind = ObstacleKind::Pole;
  out.x_m = x_m;
  out.y_m = y_m;
  out.height_m = 3.0;
  return out;
}

TEST(Footprint, RaysMeetItWhereGeometrySays) {
  Footprint box;
  box.centre_m = {2, 1};
  box.heading_rad = 0.5;
  box.length_m = 1.0;
  box.width_m = 0.4;
  // Along its own axis, from three metres away.
  const Eigen::Vector2d along(std::cos(0.5), std::sin(0.5));
  EXPECT_NEAR(box.ray_m(box.centre_m - 3 * along, along), 2.5, 1e-12);
  EXPECT_EQ(box.ray_m(box.centre_m - 3 * along, -along), kInf);
  const Eigen::Vector2d across(-along.y(), along.x());
  EXPECT_NEAR(box.ray_m(box.centre_m + 2 * across, -across), 1.8, 1e-12);
  EXPECT_EQ(box.ray_m(box.centre_m - 3 * along + 0.21 * across, along), kInf);
  EXPECT_EQ(box.ray_m(box.centre_m, along), 0.0);
  EXPECT_NEAR((box.nearest_m(box.centre_m + 2 * across) - box.centre_m).norm(), 0.2, 1e-12);
  Footprint disc;
  disc.radius_m = 0.5;
  EXPECT_NEAR(disc.ray_m({-2, 0.3}, {1, 0}), 2 - 0.4, 1e-12);
  EXPECT_EQ(disc.ray_m({-2, 0.51}, {1, 0}), kInf);
  EXPECT_EQ(disc.ray_m({2, 0}, {1, 0}), kInf);
  EXPECT_NEAR(disc.nearest_m({3, 4}).norm(), 0.5, 1e-12);
}

TEST(Footprint, AConeHearsItsNearestPartInside) {
  Footprint disc;
  disc.radius_m = 0.5;
  EXPECT_NEAR(disc.in_cone_m({-2, 0}, 0.0, 0.26), 1.5, 1e-12);
  EXPECT_NEAR(disc.in_cone_m({-2, 0}, 0.2, 0.26), 1.5, 1e-12);  // the nearest point lies in the cone still
  EXPECT_NEAR(disc.in_cone_m({-2, 0}, 0.4, 0.26), disc.ray_m({-2, 0}, {std::cos(0.14), std::sin(0.14)}),
              1e-12);
  EXPECT_EQ(disc.in_cone_m({-2, 0}, 0.6, 0.26), kInf);
  EXPECT_EQ(disc.in_cone_m({-2, 0}, M_PI, 0.26), kInf);
  EXPECT_EQ(disc.in_cone_m({0.1, 0}, 2.0, 0.26), 0.0);  // from inside
  // Against many rays, over a box and headings all round.
  Footprint box;
  box.centre_m = {1.2, 0.4};
  box.heading_rad = 0.7;
  box.length_m = 1.0;
  box.width_m = 0.4;
  for (double heading = -3.0; heading < 3.0; heading += 0.1) {
    double nearest = kInf;
    for (double off = -0.26; off <= 0.26; off += 1e-4)
      nearest = std::min(nearest, box.ray_m({0, 0}, {std::cos(heading + off), std::sin(heading + off)}));
    const double heard = box.in_cone_m({0, 0}, heading, 0.26);
    if (nearest == kInf) {
      EXPECT_TRUE(heard == kInf || heard > 0.9) << heading;  // an edge that no ray met
    } else {
      EXPECT_NEAR(heard, nearest, 1e-3) << heading;
    }
  }
}

TEST(Obstacle, ADoorwayIsTwoJambsAndALintel) {
  ObstacleSettings door;
  door.kind = ObstacleKind::Doorway;
  door.length_m = 4;
  door.opening_m = 1;
  door.height_m = 3;
  door.heading_rad = 1.5708;
  const std::vector<Block> blocks = blocks_of(door);
  ASSERT_EQ(blocks.size(), 3U);
  EXPECT_NEAR(blocks[0].length_m, 1.5, 1e-9);
  EXPECT_NEAR((blocks[0].centre_m - blocks[1].centre_m).norm(), 2.5, 1e-9);
  EXPECT_EQ(blocks[2].bottom_m, door.lintel_m);
}

TEST(Scene, APoleHidesTheBackFromTheCameraAndIsHeard) {
  Scenario scenario = empty_room();
  World clear(scenario);
  scenario.obstacles = {pole(-1.0, 0.0)};
  World hidden(scenario);
  const RobotMotion robot{-2.15, 0, 0, 0, 0};
  EXPECT_FALSE(clear.truth(robot, 0.0).occluded);
  EXPECT_TRUE(hidden.truth(robot, 0.0).occluded);
  EXPECT_TRUE(hidden.truth(robot, 0.0).in_view);  // it would be, but for the pole
  EXPECT_NEAR(hidden.range_m(-2, 0, 0, 0.0), 0.85, 1e-9);
  EXPECT_NEAR(clear.range_m(-2, 0, 0, 0.0), 2.0 - kPersonRadius_m, 1e-9);  // the person
  // The picture shows it: the two differ in the middle.
  std::vector<std::uint8_t> with, without;
  clear.render(robot, 0.0, 1, without);
  hidden.render(robot, 0.0, 1, with);
  int differ = 0;
  for (int y = 100; y < 300; ++y)
    for (int x = 310; x < 330; ++x) {
      const auto i = static_cast<std::size_t>(y) * 640 + x;
      differ += std::abs(with[i] - without[i]) > 20;
    }
  EXPECT_GT(differ, 1000);
}

TEST(Scene, ALowBoxHidesNothingOfTheBack) {
  Scenario scenario = empty_room();
  ObstacleSettings box;
  box.x_m = -1.0;
  box.height_m = 0.5;
  scenario.obstacles = {box};
  EXPECT_FALSE(World(scenario).truth({-2.15, 0, 0, 0, 0}, 0.0).occluded);
}

TEST(Scene, PassersByWearWhatTheScenarioSays) {
  Scenario scenario = empty_room();
  PasserbySettings twin;
  twin.shirt_origin = ShirtOrigin::Same;
  twin.start.y_m = 1.0;
  PasserbySettings alike = twin;
  alike.shirt_origin = ShirtOrigin::SameColours;
  scenario.passers_by = {twin, alike};
  const World world(scenario);
  ASSERT_EQ(world.people().size(), 3U);
  const auto shirt = [&](std::size_t i) {
    return world.people()[i].person.mesh(kTorso).texture->level(2).texels;
  };
  EXPECT_EQ(shirt(0), shirt(1));
  EXPECT_NE(shirt(0), shirt(2));
  // Of the same greys: the means lie close together.
  double means[2] = {0, 0};
  for (const int i : {0, 1})
    for (const std::uint8_t texel : shirt(i == 0 ? 0 : 2))
      means[i] += texel / static_cast<double>(shirt(0).size());
  EXPECT_NEAR(means[0], means[1], 12);
}

TEST(Scene, EveryPrintHasInkOnTheBackAndAnotherSeedAnotherPrint) {
  for (const ShirtDesign design :
       {ShirtDesign::Shapes, ShirtDesign::Emblem, ShirtDesign::Photo, ShirtDesign::Text}) {
    const Canvas one = draw_shirt(design, 1), other = draw_shirt(design, 2), again = draw_shirt(design, 1);
    int inked = 0, differ = 0;
    bool same = true;
    for (int y = 110; y < 600; ++y)
      for (int x = 352; x < 672; ++x) {
        inked += std::abs(one.at(x, y) - one.at(600, 5)) > 25.f;
        differ += std::abs(one.at(x, y) - other.at(x, y)) > 10.f;
        same = same && one.at(x, y) == again.at(x, y);
      }
    const double texels = 490.0 * 320.0;
    EXPECT_GT(inked / texels, 0.08) << static_cast<int>(design);
    EXPECT_GT(differ / texels, 0.05) << static_cast<int>(design);
    EXPECT_TRUE(same) << static_cast<int>(design);
  }
}

TEST(Scene, TruthIsTheBestRigidFitOfTheCloth) {
  Scenario scenario = empty_room();
  const World folded(scenario, 1, WorldUse::TruthOnly);
  scenario.person.cloth_fold_m = 0.0;
  const World rigid(scenario, 1, WorldUse::TruthOnly);
  const RobotMotion robot{-2.15, 0, 0.1, 0, 0};
  EXPECT_NEAR(rigid.truth(robot, 0.0).yaw_rad, 0.1, 1e-9);
  // Folds turn the cloth of the back by a little.
  const Truth truth = folded.truth(robot, 0.0);
  EXPECT_GT(std::abs(truth.yaw_rad - 0.1), 1e-4);
  EXPECT_LT(std::abs(truth.yaw_rad - 0.1), 0.15);
  EXPECT_NEAR(std::atan2(truth.R_cur_from_ref(0, 2), truth.R_cur_from_ref(2, 2)), truth.yaw_rad, 1e-12);
  EXPECT_NEAR(truth.back_yaw_rad, 0.1 - truth.yaw_rad, 1e-9);
}

TEST(Scene, PassersByWalkAfterTheTargetAndHideThem) {
  Scenario scenario = empty_room();
  PasserbySettings crossing;
  crossing.start = {.x_m = -1.0, .y_m = -2.0, .heading_rad = M_PI / 2};
  WalkItem ahead;
  ahead.length_m = 4.0;
  crossing.path = {ahead};
  crossing.walk_after_s = 1.0;
  scenario.passers_by = {crossing};
  World world(scenario);
  world.start_walk(5.0);
  EXPECT_EQ(world.pose_of(1, 6.0).walk.y_m, -2.0);
  EXPECT_GT(world.pose_of(1, 8.0).walk.y_m, -1.5);
  const RobotMotion robot{-2.15, 0, 0, 0, 0};
  double hidden_s = 0;
  for (double t = 5; t < 18; t += 0.05) hidden_s += world.truth(robot, t).occluded ? 0.05 : 0.0;
  EXPECT_NEAR(hidden_s, 2 * kPersonRadius_m / 0.5, 0.25);  // half a metre a second
}

TEST(Scene, WindowsAreInTheWallTheLightComesFrom) {
  Scenario scenario = empty_room();
  scenario.light.window_azimuth_rad = 0.0;
  World bare(scenario);
  scenario.room.windows = 3;
  World windows(scenario);
  // Pixels that the windows have brought to white.
  const auto whitened = [&](double heading_rad) {
    std::vector<std::uint8_t> with, without;
    bare.render({-2.0, 1.2, heading_rad, 0, 0}, 0.0, 1, without);
    windows.render({-2.0, 1.2, heading_rad, 0, 0}, 0.0, 1, with);
    int count = 0;
    for (std::size_t i = 0; i < with.size(); ++i) count += with[i] >= 250 && without[i] < 230;
    return count;
  };
  EXPECT_GT(whitened(0.2), 1500);
  EXPECT_EQ(whitened(3.0), 0);
}

}  // namespace
}  // namespace heel::sim
