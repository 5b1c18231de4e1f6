// The robot among things: it hears them, its bumpers meet them, and it does not drive through them.
#include "sim/contact/contact.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "sim/contact/robot_in_world.h"
#include "support/complaint.h"

namespace heel::sim {
namespace {

Scenario scenario_with(std::vector<ObstacleSettings> obstacles) {
  Scenario scenario;
  scenario.camera.model = default_camera_model();
  scenario.room.objects = 0;
  scenario.person_start.y_m = 5.0;
  scenario.robot.x_m = -2.0;
  scenario.obstacles = std::move(obstacles);
  return scenario;
}

/// A robot that an earlier session left driving ahead at 0.4 m/s, for as long as the watchdog lets it.
P3AtSettings driving(const Scenario& scenario) {
  P3AtSettings settings;
  settings.start = {scenario.robot.x_m, scenario.robot.y_m, scenario.robot.heading_rad};
  settings.chassis = exact_chassis();
  settings.watchdog_ns = 0;
  settings.faults.push_back(parse_fault("left_open@0=400"));
  return settings;
}

/// Steps both; the front bumpers pressed at any time.
std::uint8_t drive(P3At& robot, Contact& contact, double duration_s) {
  std::uint8_t pressed = 0;
  for (TimeNs t_ns = 0; t_ns <= ns_from_seconds(duration_s); t_ns += P3At::kStep_ns) {
    robot.advance(t_ns);
    contact.step(seconds_from_ns(t_ns));
    pressed = static_cast<std::uint8_t>(pressed | robot.truth().bumpers_front);
  }
  return pressed;
}

TEST(Contact, AWallStopsTheRobotAndPressesTheWholeBumper) {
  ObstacleSettings wall;
  wall.kind = ObstacleKind::Wall;
  wall.heading_rad = M_PI / 2;
  wall.length_m = 4.0;
  wall.width_m = 0.2;
  const Scenario scenario = scenario_with({wall});
  const World world(scenario);
  P3At robot(driving(scenario));
  Contact contact(world, robot);
  EXPECT_EQ(drive(robot, contact, 8.0), 0x1F);
  // The face of the wall is at −0.1; the robot's front 0.313 m ahead, the bumper gives 20 mm.
  EXPECT_LT(robot.true_pose().x_m, -0.1 - 0.313 + 0.021);
  EXPECT_GT(robot.true_pose().x_m, -0.1 - 0.313 - 0.005);
  EXPECT_TRUE(robot.truth().stall_left);  // BUMPSTALL: the firmware stops pushing
}

TEST(Contact, AnotherRobotMeetsTheWallWithItsOwnFront) {
  ObstacleSettings wall;
  wall.kind = ObstacleKind::Wall;
  wall.heading_rad = M_PI / 2;
  wall.length_m = 4.0;
  wall.width_m = 0.2;
  Scenario scenario = scenario_with({wall});
  const World world(scenario);
  for (const auto& [subclass, front_m] :
       {std::pair{"p3dx-sh", 0.210}, {"powerbot-sh", 0.369}, {"amigo", 0.160}}) {
    P3AtSettings settings = driving(scenario);
    use_model(subclass, settings);
    P3At robot(settings);
    Contact contact(world, robot);
    EXPECT_EQ(drive(robot, contact, 8.0), 0x1F) << subclass;
    EXPECT_LT(robot.true_pose().x_m, -0.1 - front_m + 0.021) << subclass;
    EXPECT_GT(robot.true_pose().x_m, -0.1 - front_m - 0.005) << subclass;
  }
}

TEST(RobotInWorld, AModelThatIsNotKnownIsRefused) {
  ScenarioRobot robot;
  robot.model = "p3ax";
  P3AtSettings settings;
  EXPECT_NE(test::complaint_of([&] {
              apply_robot(robot, settings);
            }).find("robot.model: 'p3ax' (expected p3at-sh, "),
            std::string::npos);
  robot.model = "p2at";
  apply_robot(robot, settings);
  EXPECT_EQ(settings.subtype, "p2at");
}

TEST(Contact, APoleToTheLeftPressesTheLeftSegments) {
  ObstacleSettings pole;
  pole.kind = ObstacleKind::Pole;
  pole.y_m = 0.2;
  pole.radius_m = 0.08;
  const Scenario scenario = scenario_with({pole});
  const World world(scenario);
  P3At robot(driving(scenario));
  Contact contact(world, robot);
  const std::uint8_t pressed = drive(robot, contact, 8.0);
  EXPECT_NE(pressed & 0x03, 0);
  EXPECT_EQ(pressed & 0x1C, 0);
}

TEST(Contact, NothingIsFeltInTheOpen) {
  const Scenario scenario = scenario_with({});
  const World world(scenario);
  P3At robot(driving(scenario));
  Contact contact(world, robot);
  EXPECT_EQ(drive(robot, contact, 4.0), 0);
  EXPECT_GT(robot.true_pose().x_m, -0.9);
}

TEST(Contact, ThePersonIsMetToo) {
  Scenario scenario = scenario_with({});
  scenario.person_start.y_m = 0.0;
  const World world(scenario);
  P3At robot(driving(scenario));
  Contact contact(world, robot);
  EXPECT_NE(drive(robot, contact, 8.0), 0);
  EXPECT_LT(robot.true_pose().x_m, -kPersonRadius_m - 0.25);
}

TEST(Contact, APatchOfFloorChangesTheTurn) {
  Scenario scenario = scenario_with({});
  scenario.robot.true_track_m = 0.588;
  scenario.robot.patches = {{.x_m = 0.0, .y_m = 0.0, .length_m = 2.0, .width_m = 2.0, .true_track_m = 0.7}};
  const World world(scenario);
  // Straight ahead with wheels of unlike size: the turn goes as 1/track.
  P3AtSettings unlike = driving(scenario);
  unlike.chassis.left_scale_error = -0.05;
  unlike.chassis.right_scale_error = 0.05;
  const auto heading_after = [&](double x_m) {
    P3At other(unlike);
    other.place({x_m, 0.0, 0.0});
    Contact with(world, other);
    for (TimeNs t_ns = 0; t_ns <= kNsPerS; t_ns += P3At::kStep_ns) {
      other.advance(t_ns);
      with.step(seconds_from_ns(t_ns));
    }
    return other.true_pose().heading_rad;
  };
  EXPECT_NEAR(heading_after(-3.0) / heading_after(-0.5), 0.7 / 0.588, 0.01);
}

/// Steps the walk alone, from 0, with the robot at rest at its start; returns the person's places, each
/// second.
std::vector<WalkState> walk_before_a_robot_at_rest(const Scenario& scenario, int seconds) {
  World world(scenario, 0, WorldUse::TruthOnly);
  P3At robot(driving(scenario));  // not advanced: it stays
  world.start_walk(0.0);
  std::vector<WalkState> states;
  for (int ms = 0; ms <= 1000 * seconds; ++ms) {
    const double t_s = 1e-3 * ms;
    hold_walk_while_robot_is_far(robot.truth(), t_s, 1e-3, world);
    if (ms % 1000 == 0) states.push_back(world.truth({}, t_s).person);
  }
  return states;
}

TEST(RobotInWorld, APersonWaitsForARobotThatIsFarAwayAndNotWithoutALimit) {
  Scenario scenario = scenario_with({});
  scenario.person_start.y_m = 0.0;
  scenario.path = {{.step = WalkStep::Straight, .speed_m_s = 0.5, .length_m = 10.0}};
  scenario.waits_beyond_m = 3.0;
  const std::vector<WalkState> waiting = walk_before_a_robot_at_rest(scenario, 8);
  EXPECT_NEAR(waiting[8].x_m, scenario.robot.x_m + 3.0, 0.1);
  EXPECT_EQ(waiting[8].speed_m_s, 0.0);
  EXPECT_NEAR(waiting[8].stride_rad, waiting[7].stride_rad, 1e-6);
  EXPECT_GT(waiting[1].speed_m_s, 0.2);

  scenario.waits_beyond_m = 0.0;
  EXPECT_GT(walk_before_a_robot_at_rest(scenario, 8)[8].x_m, 3.0);
}

}  // namespace
}  // namespace heel::sim
