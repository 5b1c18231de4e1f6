// The gate plans with the brakes that the robot has: it stops as far before a box that it has heard when its
// controller limits the deceleration, when its limits are unknown, and when its brakes are weaker than its
// controller says.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>

#include "models/robot_models.h"
#include "sim/lockstep/lockstep.h"
#include "support/test_data.h"

namespace heel::sim {
namespace {

constexpr double kBoxFront_m = 5.8;  // the person passes beside it, the robot is too wide

LockstepSettings walk_past_a_box() {
  LockstepSettings settings;
  settings.scenario = parse_scenario(R"(
seed = 5
duration_s = 25.0
[person]
walk_after_s = 0.5
[[person.path]]
step = "straight"
length_m = 12.0
[[obstacle]]
kind = "box"
x_m = 6.0
y_m = 0.45
length_m = 0.4
width_m = 0.5
[robot]
x_m = -1.9
[room]
objects = 15
)",
                                     "box.toml");
  apply_scenario(settings.scenario, settings.config);
  settings.shirt.distance_m = 1.5;
  settings.errors = read_error_model(test::source_path("tools/heel-sim/pose_noise/pictured.toml"));
  return settings;
}

class NearestToTheBox : public LockstepObserver {
 public:
  void on_tick(const TickRecord& tick, const LockstepTruth& truth) override {
    const double bumper_m = truth.robot.pose.x_m + robot_models()[0].geometry.front_m;
    distance_m = std::min(distance_m, kBoxFront_m - bumper_m);
    speed_m_s = std::max(speed_m_s, truth.robot.v_m_s);
    if (tick.input.robot.phase == LinkPhase::Running)
      planned_m_s2 = std::min(planned_m_s2, tick.planned_deceleration_m_s2);
  }
  double distance_m = std::numeric_limits<double>::infinity();
  double speed_m_s = 0.0;
  double planned_m_s2 = std::numeric_limits<double>::infinity();
};

NearestToTheBox run_with(const LockstepSettings& settings) {
  NearestToTheBox run;
  run_lockstep(settings, run);
  EXPECT_GT(run.speed_m_s, 0.35) << "it must have had something to brake";
  return run;
}

/// Where an ordinary robot stops. Not exactly at gate.clearance_m, 0.40 m: an echo is taken to lie in the
/// middle of the beam, and the box reaches only half into it.
double ordinary_m() {
  static const double distance_m = run_with(walk_past_a_box()).distance_m;
  return distance_m;
}
constexpr double kSpread_m = 0.03;

TEST(Brakes, OfAnOrdinaryRobotStopItInTime) {
  const NearestToTheBox run = run_with(walk_past_a_box());
  EXPECT_NEAR(run.distance_m, Config{}.gate.clearance_m, 0.1);
  EXPECT_EQ(run.planned_m_s2, 1.5);
}

// Its echoes are in other units: a driver that takes them for millimetres drives into the box.
TEST(Brakes, OfAnOlderModelStopItAsEarly) {
  LockstepSettings settings = walk_past_a_box();
  settings.scenario.robot.model = "p2at";
  const NearestToTheBox run = run_with(settings);
  EXPECT_GT(run.distance_m, ordinary_m() - kSpread_m);
  EXPECT_LT(run.distance_m, ordinary_m() + kSpread_m);
}

TEST(Brakes, ThatTheControllerLimitsStopItInTime) {
  LockstepSettings settings = walk_past_a_box();
  settings.scenario.robot.acceleration_top_m_s2 = 0.3;
  const NearestToTheBox run = run_with(settings);
  EXPECT_GT(run.distance_m, ordinary_m() - kSpread_m);
  EXPECT_NEAR(run.planned_m_s2, 0.3, 1e-9);
}

TEST(Brakes, OfUnknownLimitsArePlannedWithTheSmallest) {
  LockstepSettings settings = walk_past_a_box();
  settings.scenario.robot.sends_config = false;
  const NearestToTheBox run = run_with(settings);
  EXPECT_GT(run.distance_m, ordinary_m() - kSpread_m);
  EXPECT_NEAR(run.planned_m_s2, 0.3, 1e-9);
}

TEST(Brakes, ThatAreWeakerThanTheControllerSaysAreSeen) {
  LockstepSettings settings = walk_past_a_box();
  settings.scenario.robot.brakes_m_s2 = 0.3;
  settings.scenario.robot.faults.emplace_back(
      "bumper@7+0.2=4");  // there the robot must slow down for the first time
  const NearestToTheBox run = run_with(settings);
  EXPECT_LT(run.planned_m_s2, 0.4);
  EXPECT_GT(run.distance_m, ordinary_m() - kSpread_m);
}

}  // namespace
}  // namespace heel::sim
