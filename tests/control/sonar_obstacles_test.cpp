// The way ahead: which echoes lie on it, how far away, and what is remembered between two of them.
#include "control/sonar_obstacles.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace heel {
namespace {

constexpr double kEndless_m = std::numeric_limits<double>::infinity();
constexpr double kBumper_m = 0.313;
constexpr TimeNs kHeard_ns = 20 * kNsPerS;

SonarObstacles one(double x_m, double y_m) {
  SonarObstacles echoes;
  echoes.add({x_m, y_m});
  return echoes;
}

TEST(SonarObstacles, StraightAheadCountsFromTheBumper) {
  EXPECT_NEAR(one(1.5, 0.2).free_distance_m(0.5, 0.0), 1.5 - kBumper_m, 1e-12);
  EXPECT_NEAR(one(1.5, -0.2).free_distance_m(0.1, 0.0), 1.5 - kBumper_m, 1e-12);
}

TEST(SonarObstacles, TheNearestCounts) {
  SonarObstacles echoes = one(2.0, 0.0);
  echoes.add({1.0, 0.1});
  echoes.add({3.0, 0.0});
  EXPECT_NEAR(echoes.free_distance_m(0.5, 0.0), 1.0 - kBumper_m, 1e-12);
}

TEST(SonarObstacles, WhatIsBesideOrBehindOrNobodyDrivesToIsNotInTheWay) {
  EXPECT_EQ(one(1.5, 0.34).free_distance_m(0.5, 0.0), kEndless_m);
  EXPECT_EQ(one(-1.5, 0.0).free_distance_m(0.5, 0.0), kEndless_m);
  EXPECT_EQ(one(0.2, 0.3).free_distance_m(0.5, 0.0), kEndless_m);  // beside the body
  EXPECT_EQ(one(1.5, 0.0).free_distance_m(0.0, 0.5), kEndless_m);
  EXPECT_EQ(SonarObstacles().free_distance_m(0.5, 0.0), kEndless_m);
}

TEST(SonarObstacles, AtTheBumperNothingIsFree) {
  EXPECT_EQ(one(kBumper_m, 0.0).free_distance_m(0.5, 0.0), 0.0);
  EXPECT_EQ(one(0.28, 0.2).free_distance_m(0.5, 0.0), 0.0);  // nearer than it can be: pressed
}

TEST(SonarObstacles, BackwardsIsTheMirrorImageOfForwards) {
  for (const double x_m : {0.5, 1.0, 2.0})
    for (const double y_m : {-0.9, -0.2, 0.1, 0.6})
      for (const double rate_rad_s : {-0.6, 0.0, 0.4})
        EXPECT_EQ(one(-x_m, y_m).free_distance_m(-0.5, -rate_rad_s),
                  one(x_m, y_m).free_distance_m(0.5, rate_rad_s));
}

/// By driving the arc in small steps until a disc as wide as the corridor meets the point.
double driven_m(double x_m, double y_m, double v_m_s, double rate_rad_s) {
  constexpr double kDt_s = 1e-4;
  double at_x = 0.0, at_y = 0.0, heading = 0.0, before = kEndless_m;
  for (double way_m = 0.0; way_m < 3.0; way_m += v_m_s * kDt_s) {
    const double dx = x_m - at_x, dy = y_m - at_y;
    const double ahead = std::cos(heading) * dx + std::sin(heading) * dy;
    const double beside = std::cos(heading) * dy - std::sin(heading) * dx;
    if (before > 0.0 && ahead <= 0.0) return std::abs(beside) < 0.33 ? way_m : kEndless_m;
    before = ahead;
    at_x += v_m_s * kDt_s * std::cos(heading);
    at_y += v_m_s * kDt_s * std::sin(heading);
    heading += rate_rad_s * kDt_s;
  }
  return kEndless_m;
}

TEST(SonarObstacles, OnAnArcAsByDrivingIt) {
  int in_the_way = 0;
  for (const double rate_rad_s : {-0.8, -0.3, 0.2, 0.7})
    for (double x_m = 0.35; x_m < 1.6; x_m += 0.11)
      for (double y_m = -1.2; y_m < 1.2; y_m += 0.13) {
        const double driven = driven_m(x_m, y_m, 0.6, rate_rad_s);
        const double free_m = one(x_m, y_m).free_distance_m(0.6, rate_rad_s);
        if (driven == kEndless_m) {
          EXPECT_EQ(free_m, kEndless_m) << x_m << " " << y_m << " " << rate_rad_s;
        } else {
          EXPECT_NEAR(free_m, std::max(driven - kBumper_m, 0.0), 1e-3)
              << x_m << " " << y_m << " " << rate_rad_s;
          ++in_the_way;
        }
      }
  EXPECT_GT(in_the_way, 50);
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
    SonarObstacleMap memory;
    RobotState robot = robot_at(0, 0, 0, kHeard_ns);
    robot.sonar[row.sonar] = {kHeard_ns, 1.0};
    memory.see(robot);
    const SonarObstacles echoes = memory.at(kHeard_ns, robot.odometry);
    ASSERT_EQ(echoes.points().size(), 1u);
    EXPECT_NEAR(echoes.points()[0].x_m, row.x_m, 1e-6) << row.sonar;
    EXPECT_NEAR(echoes.points()[0].y_m, row.y_m, 1e-6) << row.sonar;
  }
}

TEST(SonarObstacleMap, AnEchoStaysInItsPlaceWhileTheRobotDrivesAndTurns) {
  SonarObstacleMap memory;
  RobotState robot = robot_at(1.0, 2.0, 0.5, kHeard_ns);
  robot.sonar[0] = {kHeard_ns, 1.0};  // to the left: 1.136 m
  memory.see(robot);
  robot.odometry = {kHeard_ns + 300 * kNsPerMs, 1.0, 2.0, 0.5 + M_PI / 2, 0.0, 0.0};  // turned to it
  memory.see(robot);                                                                  // nothing new
  const SonarObstacles echoes = memory.at(kHeard_ns + 300 * kNsPerMs, robot.odometry);
  ASSERT_EQ(echoes.points().size(), 1u);
  EXPECT_NEAR(echoes.points()[0].x_m, 1.136, 1e-9);
  EXPECT_NEAR(echoes.points()[0].y_m, -0.147, 1e-9);
}

TEST(SonarObstacleMap, BetweenPacketsTheRobotGoesOn) {
  SonarObstacleMap memory;
  RobotState robot = robot_at(0, 0, 0, kHeard_ns);
  robot.odometry.v_m_s = 0.5;
  robot.sonar[3] = {kHeard_ns, 1.0};
  memory.see(robot);
  const double then_m = memory.at(kHeard_ns, robot.odometry).free_distance_m(0.5, 0.0);
  const double later_m = memory.at(kHeard_ns + 100 * kNsPerMs, robot.odometry).free_distance_m(0.5, 0.0);
  EXPECT_NEAR(then_m - later_m, 0.05, 1e-9);
}

TEST(SonarObstacleMap, ANewEchoTakesThePlaceOfTheOldAndAnOldOneIsForgotten) {
  SonarObstacleMap memory;
  RobotState robot = robot_at(0, 0, 0, kHeard_ns);
  robot.sonar[3] = {kHeard_ns, 0.5};
  memory.see(robot);
  EXPECT_LT(memory.at(kHeard_ns, robot.odometry).free_distance_m(0.5, 0.0), 0.5);
  robot.sonar[3] = {kHeard_ns + 1, 5.0};
  memory.see(robot);
  EXPECT_GT(memory.at(kHeard_ns, robot.odometry).free_distance_m(0.5, 0.0), 4.0);
  EXPECT_EQ(memory.at(kHeard_ns + SonarObstacleMap::kKept_ns + 2, robot.odometry).points().size(), 0u);
  memory.clear();
  EXPECT_EQ(memory.at(kHeard_ns, robot.odometry).points().size(), 0u);
}

}  // namespace
}  // namespace heel
