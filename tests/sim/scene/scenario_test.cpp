// Scenario files: what is read, and that what cannot be understood is refused by name and place.
#include "sim/scene/scenario.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "files/camera_info.h"
#include "support/complaint.h"
#include "support/test_data.h"

namespace heel::sim {
namespace {

using test::source_path;

std::string complaint(const std::string& text) {
  return test::complaint_of([&] { parse_scenario(text, "s.toml"); });
}

TEST(Scenario, ReadsWhatIsWritten) {
  const Scenario s = parse_scenario(R"(
name = "x"
seed = 42
[person]
shirt = "striped"
heading_deg = 90.0
[[person.path]]
step = "arc"
radius_m = 2
angle_deg = -90
[[person.path]]
step = "pause"
duration_s = 1.5
[camera]
rate_hz = 15
focal_px = [400.0, 401.0]
[robot]
faults = ["drop@10+5=0.02"]
[room]
objects = 3
)",
                                    "dir/s.toml");
  EXPECT_EQ(s.name, "x");
  EXPECT_EQ(s.seed, 42U);
  EXPECT_EQ(s.person.shirt, ShirtDesign::Striped);
  EXPECT_NEAR(s.person_start.heading_rad, 1.5707963, 1e-6);
  ASSERT_EQ(s.path.size(), 2U);
  EXPECT_EQ(s.path[0].step, WalkStep::Arc);
  EXPECT_NEAR(s.path[0].angle_rad, -1.5707963, 1e-6);
  EXPECT_EQ(s.path[1].duration_s, 1.5);
  EXPECT_EQ(s.camera.rate_hz, 15);
  EXPECT_EQ(s.camera.model.fy, 401);
  EXPECT_EQ(s.robot.faults, std::vector<std::string>{"drop@10+5=0.02"});
  EXPECT_EQ(s.room.objects, 3);
}

TEST(Scenario, RefusesByNameAndPlace) {
  EXPECT_EQ(complaint("seed = 1\nsead = 2\n").substr(0, 29), "s.toml:2:1: sead: no such key");
  EXPECT_NE(complaint("seed = 1\nsead = 2\n").find("; did you mean seed? (expected one of: camera, "),
            std::string::npos);
  EXPECT_EQ(complaint("[camera]\nrate_hz = \"fast\"\n"),
            "s.toml:2:11: camera.rate_hz: 'fast' (expected a number 1…240 Hz)");
  EXPECT_EQ(complaint("[camera]\nrate_hz = 1e6\n"),
            "s.toml:2:11: camera.rate_hz: 1000000.0 (expected a number 1…240 Hz)");
  EXPECT_NE(complaint("[person]\nshirt = \"tweed\"\n").find("s.toml:2:9: person.shirt: 'tweed'"),
            std::string::npos);
  EXPECT_NE(complaint("[[person.path]]\nstep = \"fly\"\n").find("person.path.step: 'fly'"),
            std::string::npos);
  EXPECT_NE(
      complaint("[[person.path]]\nstep = \"arc\"\nradius_m = 1\n").find("person.path.angle_deg: missing"),
      std::string::npos);
  EXPECT_NE(
      complaint("[[person.path]]\nstep = \"pause\"\nduration_s = 1\nlength_m = 1\n").find("no such key"),
      std::string::npos);
  EXPECT_NE(complaint("[person]\nhair = \"mohawk\"\n").find("s.toml:2:8: person.hair: 'mohawk'"),
            std::string::npos);
  EXPECT_NE(complaint("[[passerby]]\nshirt = \"tweed\"\n").find("passerby.shirt: 'tweed'"),
            std::string::npos);
  EXPECT_NE(complaint("[[obstacle]]\nkind = \"moat\"\nx_m = 0\ny_m = 0\n").find("obstacle.kind: 'moat'"),
            std::string::npos);
  EXPECT_NE(complaint("[[obstacle]]\nkind = \"pole\"\ny_m = 0\n").find("obstacle.x_m: missing"),
            std::string::npos);
  EXPECT_NE(complaint("[[obstacle]]\nkind = \"doorway\"\nx_m = 0\ny_m = 0\nopening_m = 3.5\n")
                .find("obstacle.opening_m: not narrower"),
            std::string::npos);
  EXPECT_NE(complaint("[camera.exposure]\nautomatic = 1\n")
                .find("camera.exposure.automatic: 1 (expected true or false)"),
            std::string::npos);
  EXPECT_NE(complaint("[[light.change]]\nat_s = 5\nlevel = 1\n[[light.change]]\nat_s = 4\nlevel = 1\n")
                .find("s.toml:5:8: light.change.at_s: not after"),
            std::string::npos);
  EXPECT_NE(complaint("[camera]\nsource = \"usb\"\n").find("camera.source"), std::string::npos);
  EXPECT_NE(complaint("[camera]\ndistortion = [1.0]\n").find("camera.distortion"), std::string::npos);
  EXPECT_NE(complaint("[camera\n").find("s.toml:1:"), std::string::npos);
  EXPECT_NE(complaint("seed = -1\n").find("seed"), std::string::npos);
}

TEST(Scenario, ReadsPeopleObstaclesAndTheCamerasTroubles) {
  const Scenario s = parse_scenario(R"(
shows = "much"
[person]
hair = "ponytail"
[[person.path]]
step = "aside"
left_m = -0.5
[[person.path]]
step = "back"
length_m = 2
[[person.path]]
step = "sit"
duration_s = 6
[[passerby]]
shirt = "same"
x_m = 1.5
walk_after_s = 4
[[passerby.path]]
step = "straight"
length_m = 3
[[passerby]]
shirt = "jersey"
[[obstacle]]
kind = "doorway"
x_m = 4
y_m = 0
heading_deg = 90
opening_m = 1.1
[[obstacle]]
kind = "pole"
x_m = 2
y_m = 1
radius_m = 0.1
[camera]
readout_ms = 20
jpeg_quality = 60
drop_share = 0.05
glare = 0.1
[camera.exposure]
automatic = true
[robot]
[[robot.floor]]
x_m = 1
y_m = 0
length_m = 2
width_m = 3
true_track_m = 0.7
[room]
windows = 3
bump_m = 0.003
[light]
[[light.change]]
at_s = 5
level = 0.2
)",
                                    "s.toml");
  EXPECT_EQ(s.shows, "much");
  EXPECT_EQ(s.person.hair, Hair::Ponytail);
  ASSERT_EQ(s.path.size(), 3U);
  EXPECT_EQ(s.path[0].step, WalkStep::Aside);
  EXPECT_EQ(s.path[0].length_m, -0.5);
  EXPECT_EQ(s.path[1].step, WalkStep::Back);
  EXPECT_EQ(s.path[2].step, WalkStep::Sit);
  ASSERT_EQ(s.passers_by.size(), 2U);
  EXPECT_EQ(s.passers_by[0].shirt_origin, ShirtOrigin::Same);
  EXPECT_EQ(s.passers_by[0].walk_after_s, 4.0);
  EXPECT_EQ(s.passers_by[0].path.size(), 1U);
  EXPECT_EQ(s.passers_by[1].person.shirt, ShirtDesign::Jersey);
  ASSERT_EQ(s.obstacles.size(), 2U);
  EXPECT_EQ(s.obstacles[0].kind, ObstacleKind::Doorway);
  EXPECT_EQ(s.obstacles[0].opening_m, 1.1);
  EXPECT_EQ(s.obstacles[1].radius_m, 0.1);
  EXPECT_EQ(s.camera.readout_ms, 20);
  EXPECT_EQ(s.camera.jpeg_quality, 60);
  EXPECT_EQ(s.camera.timing.drop_share, 0.05);
  EXPECT_TRUE(s.camera.exposure.automatic);
  ASSERT_EQ(s.robot.patches.size(), 1U);
  EXPECT_EQ(s.robot.patches[0].true_track_m, 0.7);
  EXPECT_EQ(s.room.windows, 3);
  ASSERT_EQ(s.light.changes.size(), 1U);
  EXPECT_EQ(s.light.changes[0].level, 0.2);
}

TEST(Scenario, MissingFileIsNamed) {
  EXPECT_NE(test::complaint_of([] { read_scenario("/nonexistent/x.toml"); }).find("/nonexistent/x.toml"),
            std::string::npos);
}

TEST(Scenario, ShippedDemoHasAStraightAndBendsBothWays) {
  const Scenario s = read_scenario(source_path("tools/heel-sim/scenarios/demo.toml"));
  bool left = false, right = false, straight = false;
  for (const WalkItem& item : s.path) {
    straight |= item.step == WalkStep::Straight && item.length_m > 3;
    left |= item.step == WalkStep::Arc && item.angle_rad > 1;
    right |= item.step == WalkStep::Arc && item.angle_rad < -1;
  }
  EXPECT_TRUE(straight && left && right);
  EXPECT_GE(s.duration_s, 60);
}

TEST(Scenario, ShippedOnesSayWhatTheyShowAndNobodyWalksThroughThings) {
  int files = 0, obstacles = 0;
  for (const auto& entry : std::filesystem::directory_iterator(source_path("tools/heel-sim/scenarios"))) {
    if (entry.path().extension() != ".toml") continue;
    ++files;
    const std::string name = entry.path().stem().string();
    const Scenario s = read_scenario(entry.path().string());
    EXPECT_EQ(s.name, name);
    EXPECT_FALSE(s.shows.empty()) << name;
    obstacles += static_cast<int>(s.obstacles.size());
    std::vector<Walk> walks{Walk(s.person_start, s.path)};
    for (const PasserbySettings& passerby : s.passers_by) walks.emplace_back(passerby.start, passerby.path);
    EXPECT_LT(walks[0].duration_s() + s.walk_after_s + 1.0, s.duration_s) << name << ": ends before the walk";
    for (const Walk& walk : walks)
      for (const WalkState& at : walk.samples())
        for (const ObstacleSettings& obstacle : s.obstacles) {
          const Eigen::Vector2d feet(at.x_m, at.y_m);
          if (obstacle.kind == ObstacleKind::Pole) {
            EXPECT_GT((feet - Eigen::Vector2d(obstacle.x_m, obstacle.y_m)).norm(), obstacle.radius_m + 0.2)
                << name;
          }
          for (const Block& block : blocks_of(obstacle)) {
            if (block.bottom_m > 0.0) continue;
            const Footprint print{block.centre_m, block.heading_rad, block.length_m, block.width_m};
            EXPECT_GT((feet - print.nearest_m(feet)).norm(), 0.2) << name;
          }
        }
  }
  EXPECT_GE(files, 15);
  EXPECT_GT(obstacles, 0);
}

TEST(Scenario, ShippedCameraFileIsTheSimulatorsCamera) {
  const CameraModel file = read_camera_model(source_path("config/camera/sim.yaml"));
  for (const CameraModel& sim :
       {default_camera_model(),
        read_scenario(source_path("tools/heel-sim/scenarios/demo.toml")).camera.model}) {
    EXPECT_EQ(file.width_px, sim.width_px);
    EXPECT_EQ(file.height_px, sim.height_px);
    EXPECT_DOUBLE_EQ(file.fx, sim.fx);
    EXPECT_DOUBLE_EQ(file.fy, sim.fy);
    EXPECT_DOUBLE_EQ(file.cx, sim.cx);
    EXPECT_DOUBLE_EQ(file.cy, sim.cy);
    EXPECT_DOUBLE_EQ(file.k1, sim.k1);
    EXPECT_DOUBLE_EQ(file.k2, sim.k2);
    EXPECT_DOUBLE_EQ(file.p1, sim.p1);
    EXPECT_DOUBLE_EQ(file.p2, sim.p2);
    EXPECT_DOUBLE_EQ(file.k3, sim.k3);
  }
}

}  // namespace
}  // namespace heel::sim
