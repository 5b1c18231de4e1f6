// Which sonar obstacles lie on the path ahead, how far away they are, and how they are kept between readings.
#include "control/sonar_obstacles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "models/robot_models.h"

namespace heel {
namespace {

constexpr double kInfinite_m = std::numeric_limits<double>::infinity();
constexpr double kBumper_m = 0.313;
constexpr double kClearance_m = 0.4;
constexpr TimeNs kRead_ns = 20 * kNsPerS;

SonarObstacles one(double x_m, double y_m) {
  SonarObstacles obstacles(robot_models()[0].geometry);
  obstacles.add({x_m, y_m});
  return obstacles;
}

TEST(SonarObstacles, StraightAheadCountsFromTheBumper) {
  EXPECT_NEAR(one(1.5, 0.2).way(0.5, 0.0, kClearance_m).free_m, 1.5 - kBumper_m, 1e-12);
  EXPECT_NEAR(one(1.5, -0.2).way(0.1, 0.0, kClearance_m).free_m, 1.5 - kBumper_m, 1e-12);
}

TEST(SonarObstacles, TheNearestCounts) {
  SonarObstacles obstacles = one(2.0, 0.0);
  obstacles.add({1.0, 0.1});
  obstacles.add({3.0, 0.0});
  EXPECT_NEAR(obstacles.way(0.5, 0.0, kClearance_m).free_m, 1.0 - kBumper_m, 1e-12);
}

TEST(SonarObstacles, ObstaclesBesideBehindOrOffThePathDoNotCount) {
  EXPECT_EQ(one(1.5, 0.34).way(0.5, 0.0, kClearance_m).free_m, kInfinite_m);
  EXPECT_EQ(one(-1.5, 0.0).way(0.5, 0.0, kClearance_m).free_m, kInfinite_m);
  EXPECT_EQ(one(0.2, 0.3).way(0.5, 0.0, kClearance_m).free_m, kInfinite_m);  // beside the body
  EXPECT_EQ(one(1.5, 0.0).way(0.0, 0.5, kClearance_m).free_m, kInfinite_m);
  EXPECT_EQ(SonarObstacles(robot_models()[0].geometry).way(0.5, 0.0, kClearance_m).free_m, kInfinite_m);
}

TEST(SonarObstacles, AtTheBumperNothingIsFree) {
  EXPECT_EQ(one(kBumper_m, 0.0).way(0.5, 0.0, kClearance_m).free_m, 0.0);
  EXPECT_EQ(one(0.28, 0.2).way(0.5, 0.0, kClearance_m).free_m,
            0.0);  // behind the bumper's edge: it is pressed
}

TEST(SonarObstacles, TheRoomEndsTheClearanceShortButForWhatIsOnlyBesideTheRobot) {
  const auto room_m = [](double y_m) { return one(1.0, y_m).way(0.5, 0.0, kClearance_m).room_m; };
  const double free_m = 1.0 - kBumper_m;
  EXPECT_NEAR(room_m(0.0), free_m - kClearance_m, 1e-12);
  EXPECT_NEAR(room_m(-0.249), free_m - kClearance_m, 1e-12);
  EXPECT_NEAR(room_m(0.3299), free_m - kClearance_m, 1e-12) << "far away it counts as if it were in the way";
  EXPECT_EQ(room_m(0.3301), kInfinite_m);
  EXPECT_NEAR(one(0.4, 0.0).way(0.5, 0.0, kClearance_m).room_m, 0.4 - kBumper_m - kClearance_m, 1e-12);
  EXPECT_LT(one(0.5, 0.26).way(0.5, 0.0, kClearance_m).room_m, 0.0);
  EXPECT_NEAR(one(0.5, 0.30).way(0.5, 0.0, kClearance_m).room_m, 0.04, 1e-9) << "it passes slowly";
  EXPECT_NEAR(one(kBumper_m, 0.30).way(0.5, 0.0, kClearance_m).room_m, 0.04, 1e-9);
  EXPECT_EQ(one(kBumper_m, 0.2).way(0.5, 0.0, 0.0).room_m, 0.0) << "nor without a clearance into something";
}

SonarObstacles moving(double x_m, double y_m, double reach_m) {
  SonarObstacles obstacles(robot_models()[0].geometry);
  obstacles.add({x_m, y_m, reach_m});
  return obstacles;
}

TEST(SonarObstacles, WhatMovesMayComeIntoTheWayAndNearer) {
  const auto way = [](double y_m, double reach_m) {
    return moving(1.5, y_m, reach_m).way(0.5, 0.0, kClearance_m);
  };
  EXPECT_NEAR(way(0.0, 0.5).free_m, 1.5 - kBumper_m - 0.5, 1e-12);
  EXPECT_NEAR(way(0.33 + 0.3, 0.5).free_m, 1.5 - kBumper_m - 0.4, 1e-9);  // 3, 4, 5
  EXPECT_NEAR(way(-0.33 - 0.3, 0.5).room_m, 1.5 - kBumper_m - 0.4 - kClearance_m, 1e-9);
  EXPECT_EQ(way(0.33 + 0.51, 0.5).free_m, kInfinite_m) << "it does not come so far";
  EXPECT_EQ(way(0.33 + 0.3, 0.0).free_m, kInfinite_m) << "it stands";
  EXPECT_EQ(moving(0.5, 0.0, 0.5).way(0.5, 0.0, kClearance_m).free_m, 0.0);
}

TEST(SonarObstacles, TheFollowedPersonIsNotExpectedToCome) {
  const auto reach_m = [](double x_m, double y_m) {
    SonarObstacles obstacles = moving(x_m, y_m, 0.5);
    obstacles.expect_person({1.7, 0.1});
    return obstacles.points()[0].reach_m;
  };
  EXPECT_EQ(reach_m(1.6, 0.3), 0.0);
  EXPECT_EQ(reach_m(1.3, 0.1), 0.5) << "somebody between person and robot";
  EXPECT_EQ(reach_m(1.4, 0.9), 0.5) << "somebody beside the person";
}

TEST(SonarObstacles, BackwardsIsTheMirrorImageOfForwards) {
  int in_the_way = 0;
  for (const double x_m : {0.5, 1.0, 2.0})
    for (const double y_m : {-0.9, -0.2, 0.1, 0.6})
      for (const double rate_rad_s : {-0.6, 0.0, 0.4}) {
        const double forwards_m = one(x_m, y_m).way(0.5, rate_rad_s, kClearance_m).free_m;
        EXPECT_EQ(one(-x_m, y_m).way(-0.5, -rate_rad_s, kClearance_m).free_m, forwards_m);
        in_the_way += forwards_m != kInfinite_m;
      }
  EXPECT_GT(in_the_way, 10);
}

/// The distance along the arc to the point, found by small steps; infinite when the point is outside the
/// corridor.
double driven_m(double x_m, double y_m, double v_m_s, double rate_rad_s) {
  constexpr double kDt_s = 1e-4;
  double at_x = 0.0, at_y = 0.0, heading = 0.0, before = kInfinite_m;
  for (double way_m = 0.0; way_m < 3.0; way_m += v_m_s * kDt_s) {
    const double dx = x_m - at_x, dy = y_m - at_y;
    const double ahead = std::cos(heading) * dx + std::sin(heading) * dy;
    const double beside = std::cos(heading) * dy - std::sin(heading) * dx;
    if (before > 0.0 && ahead <= 0.0) return std::abs(beside) < 0.33 ? way_m : kInfinite_m;
    before = ahead;
    at_x += v_m_s * kDt_s * std::cos(heading);
    at_y += v_m_s * kDt_s * std::sin(heading);
    heading += rate_rad_s * kDt_s;
  }
  return kInfinite_m;
}

TEST(SonarObstacles, OnAnArcEqualsTheDistanceFoundByDriving) {
  int obstacles_in_the_way = 0;
  for (const double rate_rad_s : {-0.8, -0.3, 0.2, 0.7})
    for (double x_m = 0.35; x_m < 1.6; x_m += 0.11)
      for (double y_m = -1.2; y_m < 1.2; y_m += 0.13) {
        const double driven = driven_m(x_m, y_m, 0.6, rate_rad_s);
        const double free_m = one(x_m, y_m).way(0.6, rate_rad_s, kClearance_m).free_m;
        if (driven == kInfinite_m) {
          EXPECT_EQ(free_m, kInfinite_m) << x_m << " " << y_m << " " << rate_rad_s;
        } else {
          EXPECT_NEAR(free_m, std::max(driven - kBumper_m, 0.0), 1e-3)
              << x_m << " " << y_m << " " << rate_rad_s;
          ++obstacles_in_the_way;
        }
      }
  EXPECT_GT(obstacles_in_the_way, 50);
}

RobotState robot_at(double x_m, double y_m, double heading_rad, TimeNs t_ns) {
  RobotState robot;
  robot.has_sip = true;
  robot.odometry = {t_ns, x_m, y_m, heading_rad, 0.0, 0.0};
  return robot;
}

TEST(SonarObstacleMap, PlacesEveryBeamWhereTheManualPutsItsSonar) {
  struct Row {
    std::size_t sonar;
    double x_m, y_m;  // of an echo at 1 m
  };
  const Row rows[] = {{0, 0.147, 1.136},
                      {3, 0.245 + std::cos(0.1745329), 0.027 + std::sin(0.1745329)},
                      {4, 0.245 + std::cos(0.1745329), -0.027 - std::sin(0.1745329)},
                      {6, 0.193 + std::cos(0.8726646), -0.119 - std::sin(0.8726646)},
                      {7, 0.147, -1.136},
                      {8, -0.144, -1.136},
                      {11, -0.241 - std::cos(0.1745329), -0.027 - std::sin(0.1745329)},
                      {15, -0.144, 1.136}};
  for (const Row& row : rows) {
    SonarObstacleMap map(robot_models()[0].geometry);
    RobotState robot = robot_at(0, 0, 0, kRead_ns);
    robot.sonar[row.sonar] = {kRead_ns, 1.0};
    map.update(robot);
    const SonarObstacles obstacles = map.obstacles_at(kRead_ns, robot.odometry);
    ASSERT_EQ(obstacles.points().size(), 1u);
    EXPECT_NEAR(obstacles.points()[0].x_m, row.x_m, 1e-6) << row.sonar;
    EXPECT_NEAR(obstacles.points()[0].y_m, row.y_m, 1e-6) << row.sonar;
  }
}

TEST(SonarObstacleMap, AnEchoStaysInItsPlaceWhileTheRobotDrivesAndTurns) {
  SonarObstacleMap map(robot_models()[0].geometry);
  RobotState robot = robot_at(1.0, 2.0, 0.5, kRead_ns);
  robot.sonar[0] = {kRead_ns, 1.0};  // to the left: 1.136 m
  map.update(robot);
  robot.odometry = {kRead_ns + 300 * kNsPerMs, 1.0, 2.0, 0.5 + M_PI / 2, 0.0, 0.0};  // turned to it
  map.update(robot);                                                                 // nothing new
  const SonarObstacles obstacles = map.obstacles_at(kRead_ns + 300 * kNsPerMs, robot.odometry);
  ASSERT_EQ(obstacles.points().size(), 1u);
  EXPECT_NEAR(obstacles.points()[0].x_m, 1.136, 1e-9);
  EXPECT_NEAR(obstacles.points()[0].y_m, -0.147, 1e-9);
}

TEST(SonarObstacleMap, BetweenPacketsTheRobotsMotionIsExtrapolated) {
  SonarObstacleMap map(robot_models()[0].geometry);
  RobotState robot = robot_at(0, 0, 0, kRead_ns);
  robot.odometry.v_m_s = 0.5;
  robot.sonar[3] = {kRead_ns, 1.0};
  map.update(robot);
  const double then_m = map.obstacles_at(kRead_ns, robot.odometry).way(0.5, 0.0, kClearance_m).free_m;
  const double later_m =
      map.obstacles_at(kRead_ns + 100 * kNsPerMs, robot.odometry).way(0.5, 0.0, kClearance_m).free_m;
  EXPECT_NEAR(then_m - later_m, 0.05, 1e-9);
}

TEST(SonarObstacleMap, ANewReadingReplacesTheOldAndAnOldOneIsDropped) {
  SonarObstacleMap map(robot_models()[0].geometry);
  RobotState robot = robot_at(0, 0, 0, kRead_ns);
  robot.sonar[3] = {kRead_ns, 0.5};
  map.update(robot);
  EXPECT_LT(map.obstacles_at(kRead_ns, robot.odometry).way(0.5, 0.0, kClearance_m).free_m, 0.5);
  robot.sonar[3] = {kRead_ns + 1, 5.0};
  map.update(robot);
  EXPECT_GT(map.obstacles_at(kRead_ns, robot.odometry).way(0.5, 0.0, kClearance_m).free_m, 4.0);
  EXPECT_EQ(map.obstacles_at(kRead_ns + SonarObstacleMap::kKept_ns + 2, robot.odometry).points().size(), 0u);
  map.clear();
  EXPECT_EQ(map.obstacles_at(kRead_ns, robot.odometry).points().size(), 0u);
  map.update(robot);
  EXPECT_EQ(map.obstacles_at(kRead_ns, robot.odometry).points().size(), 0u) << "the reading is an old one";
}

/// A robot whose sonars hear one disc, as the simulated ones do: one sonar after the other, 40 ms apart.
struct Listening {
  SonarObstacleMap map{robot_models()[0].geometry};
  RobotState robot = robot_at(0, 0, 0, kRead_ns);
  std::size_t next = 0;

  /// `y_m(t)`: of the disc, `x_m` ahead of where the robot began; the robot drives `v_m_s`.
  template <typename Place>
  void sweep(int readings, double v_m_s, double x_m, const Place& y_m) {
    for (int i = 0; i < readings; ++i, next = (next + 1) % 8) {
      const TimeNs t_ns = robot.odometry.t_ns + 40 * kNsPerMs;
      const double t_s = seconds_from_ns(t_ns - kRead_ns);
      robot.odometry = {t_ns, v_m_s * t_s, 0.0, 0.0, v_m_s, 0.0};
      const Pose2& mount = robot_models()[0].geometry.sonars[next];
      const double dx_m = x_m - v_m_s * t_s - mount.x_m, dy_m = y_m(t_s) - mount.y_m;
      const double off_rad = std::abs(std::atan2(dy_m, dx_m) - mount.heading_rad);
      robot.sonar[next] = {t_ns, off_rad < 0.26 ? std::hypot(dx_m, dy_m) : 5.0};
      map.update(robot);
    }
  }
  double free_m() const {
    return map.obstacles_at(robot.odometry.t_ns, robot.odometry).way(0.5, 0.0, kClearance_m).free_m;
  }
};

TEST(SonarObstacleMap, SomebodyWhoComesFromTheSideIsInTheWayBeforeTheyAreThere) {
  const auto first_m = [](double v_m_s) {
    Listening crossing;
    double y_m = 0.0;
    for (int i = 0; i < 60; ++i) {
      crossing.sweep(1, v_m_s, 1.0 + 1.4 * v_m_s, [&](double t_s) { return y_m = 2.0 - 1.0 * t_s; });
      if (std::isfinite(crossing.free_m())) return y_m;
    }
    return 0.0;
  };
  // The way ends 0.33 m beside the robot's middle.
  EXPECT_GT(first_m(0.0), 0.55);
  EXPECT_GT(first_m(0.5), 0.65);
}

TEST(SonarObstacleMap, APoleThatTheRobotDrivesPastIsNotExpectedToCome) {
  Listening past;
  int heard = 0;
  for (int i = 0; i < 100; ++i) {
    past.sweep(1, 0.5, 2.2, [](double) { return 0.7; });
    const SonarObstacles obstacles = past.map.obstacles_at(past.robot.odometry.t_ns, past.robot.odometry);
    for (const ObstaclePoint& point : obstacles.points()) {
      EXPECT_EQ(point.reach_m, 0.0) << i << ": " << point.x_m << ", " << point.y_m;
      heard += std::hypot(point.x_m, point.y_m) < 2.5;
    }
  }
  EXPECT_GT(heard, 50);
}

}  // namespace
}  // namespace heel
