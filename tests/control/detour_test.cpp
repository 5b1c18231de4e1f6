// The offset beside the trail at which the robot passes an obstacle: the smallest that is free, on the side
// once chosen, and back when the way is free.
#include "control/detour.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "models/robot_models.h"

namespace heel {
namespace {

constexpr double kMost_m = 0.3;

/// A robot at rest on a straight trail, with the person 3 m ahead.
struct BlockedRobot {
  Trail trail;
  Detour detour;
  Pose2 robot;
  TimeNs now_ns = kNsPerS;

  const RobotModel& model;

  explicit BlockedRobot(const char* subclass = "p3at-sh") : model(robot_model(subclass)) {
    for (double x_m = 0.0; x_m <= 3.0; x_m += 0.02) trail.add({x_m, 0.0}, 0.0, 0.03, robot);
    detour.reconfigure(kMost_m);
  }
  double offset_after(double seconds, const std::vector<ObstaclePoint>& echoes, bool blocked = true) {
    SonarObstacles obstacles(model.geometry);
    for (const ObstaclePoint& echo : echoes) obstacles.add(echo);
    double offset_m = 0.0;
    for (double t_s = 0.0; t_s < seconds; t_s += 0.02) {
      now_ns += 20 * kNsPerMs;
      offset_m = detour.offset_m(trail, 0.0, robot, obstacles, blocked, now_ns);
    }
    return offset_m;
  }
};

TEST(Detour, TakesTheSmallestOffsetThatIsFree) {
  EXPECT_NEAR(BlockedRobot().offset_after(4.0, {{1.0, 0.2}}), -0.2, 0.06);
  EXPECT_NEAR(BlockedRobot().offset_after(4.0, {{1.0, -0.3}}), 0.1, 0.06);
  EXPECT_EQ(BlockedRobot().offset_after(4.0, {{1.0, 0.5}}), 0.0);  // beside the way
}

TEST(Detour, AWiderRobotKeepsFartherAwayAndANarrowOnePassesNearer) {
  EXPECT_NEAR(BlockedRobot("powerbot-sh").offset_after(4.0, {{1.0, 0.2}}), -0.3, 0.011);
  EXPECT_NEAR(BlockedRobot("amigo").offset_after(4.0, {{1.0, 0.2}}), -0.1, 0.06);
}

TEST(Detour, StaysOnTheTrailWhenNothingWithinItsLimitIsFree) {
  EXPECT_EQ(BlockedRobot().offset_after(4.0, {{1.0, 0.0}}), 0.0);
  EXPECT_EQ(BlockedRobot().offset_after(4.0, {{1.0, 0.2}, {1.2, -0.2}}), 0.0);
  BlockedRobot never;
  never.detour.reconfigure(0.0);
  EXPECT_EQ(never.offset_after(4.0, {{1.0, 0.2}}), 0.0);
}

TEST(Detour, OneEchoIsNotEnough) {
  BlockedRobot run;
  EXPECT_EQ(run.offset_after(0.25, {{1.0, 0.2}}), 0.0);
  EXPECT_LT(run.offset_after(0.5, {{1.0, 0.2}}), 0.0);
}

TEST(Detour, EchoesOfThePersonDoNotCount) {
  EXPECT_EQ(BlockedRobot().offset_after(4.0, {{2.8, 0.1}}), 0.0);
}

TEST(Detour, ReturnsAfterTheWayHasBeenFree) {
  BlockedRobot run;
  const double passing_m = run.offset_after(4.0, {{1.0, 0.2}});
  EXPECT_EQ(run.offset_after(1.5, {}, false), passing_m);
  EXPECT_EQ(run.offset_after(4.0, {}, false), 0.0);
}

TEST(Detour, ChangesTheOffsetSlowly) {
  BlockedRobot run;
  double before_m = run.offset_after(0.4, {{1.0, 0.2}});
  for (int i = 0; i < 100; ++i) {
    const double offset_m = run.offset_after(0.02, {{1.0, 0.2}});
    ASSERT_LE(std::abs(offset_m - before_m), 0.0031);
    before_m = offset_m;
  }
}

}  // namespace
}  // namespace heel
