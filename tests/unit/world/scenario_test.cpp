// Scenario files: what is read, and that what cannot be understood is refused by name and place.
#include "heel-sim/world/scenario.h"

#include <gtest/gtest.h>

#include <string>

#include "heel/error.h"

namespace heel::sim {
namespace {

std::string complaint(const std::string& text) {
  try {
    parse_scenario(text, "s.toml");
  } catch (const Error& error) {
    return error.what();
  }
  return "";
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
  EXPECT_EQ(complaint("seed = 1\nsead = 2\n").substr(0, 29), "s.toml:2:1: sead: unknown key");
  EXPECT_EQ(complaint("[camera]\nrate_hz = \"fast\"\n").substr(0, 42),
            "s.toml:2:11: camera.rate_hz: not a number ");
  EXPECT_NE(complaint("[camera]\nrate_hz = 1e6\n").find("camera.rate_hz: 1e+06 is out of range"),
            std::string::npos);
  EXPECT_NE(complaint("[person]\nshirt = \"tweed\"\n").find("s.toml:2:9: person.shirt: 'tweed'"),
            std::string::npos);
  EXPECT_NE(complaint("[[person.path]]\nstep = \"fly\"\n").find("person.path.step: 'fly'"),
            std::string::npos);
  EXPECT_NE(
      complaint("[[person.path]]\nstep = \"arc\"\nradius_m = 1\n").find("person.path.angle_deg: missing"),
      std::string::npos);
  EXPECT_NE(
      complaint("[[person.path]]\nstep = \"pause\"\nduration_s = 1\nlength_m = 1\n").find("unknown key"),
      std::string::npos);
  EXPECT_NE(complaint("[camera]\nsource = \"usb\"\n").find("camera.source"), std::string::npos);
  EXPECT_NE(complaint("[camera]\ndistortion = [1.0]\n").find("camera.distortion"), std::string::npos);
  EXPECT_NE(complaint("[camera\n").find("s.toml:1:"), std::string::npos);
  EXPECT_NE(complaint("seed = -1\n").find("seed"), std::string::npos);
}

TEST(Scenario, MissingFileIsNamed) {
  try {
    read_scenario("/nonexistent/x.toml");
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("/nonexistent/x.toml"), std::string::npos);
  }
}

TEST(Scenario, ShippedDemoHasAStraightAndBendsBothWays) {
  const Scenario s = read_scenario(HEEL_SOURCE_DIR "/tools/heel-sim/scenarios/demo.toml");
  bool left = false, right = false, straight = false;
  for (const WalkItem& item : s.path) {
    straight |= item.step == WalkStep::Straight && item.length_m > 3;
    left |= item.step == WalkStep::Arc && item.angle_rad > 1;
    right |= item.step == WalkStep::Arc && item.angle_rad < -1;
  }
  EXPECT_TRUE(straight && left && right);
  EXPECT_GE(s.duration_s, 60);
}

TEST(Scenario, ShippedCameraFileIsTheSimulatorsCamera) {
  const CameraModel file = read_camera_model(HEEL_SOURCE_DIR "/config/camera/sim.yaml");
  for (const CameraModel& sim :
       {default_camera_model(),
        read_scenario(HEEL_SOURCE_DIR "/tools/heel-sim/scenarios/demo.toml").camera.model}) {
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
