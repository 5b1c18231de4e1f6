// The law "trail" with an exact robot and exactly known people: on their path, at the set distance, without
// lag; what it does when they step aside, come back, are lost, and when an obstacle stands on the trail.
#include "control/trail_law.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "control/comfort_limiter.h"
#include "core/angles.h"
#include "estimate/floor_truth.h"
#include "models/robot_models.h"

namespace heel {
namespace {

constexpr double kLoop_s = 0.02;
constexpr double kBackBehindAxis_m = 0.12;
constexpr double kSet_m = 1.65;  // robot's centre to the back

/// A loop with an exact robot that carries out the limited commands at once.
struct TrailLoop {
  Config config;
  TrailLaw law{config};
  ComfortLimiter comfort;
  Pose2 robot, person{kSet_m + kBackBehindAxis_m, 0.0, 0.0};
  double person_m_s = 0.0, person_rad_s = 0.0;
  bool seen = true, searching = false;
  TimeNs now_ns = kNsPerS;
  TargetState target;
  VelocityCommand command;
  WantedVelocity wanted;
  double longest_jerk_m_s3 = 0.0;
  SonarObstacles obstacles{robot_models()[0].geometry};
  std::vector<Pose2> path;

  TrailLoop() {
    config.control.trail_delay_s = 0.0;
    law.reconfigure(config);
    comfort.reconfigure(config);
  }
  void tick() {
    now_ns += 20 * kNsPerMs;
    person = test::moved(person, person_m_s, person_rad_s, kLoop_s);
    path.push_back(person);
    if (seen) look();
    RobotState state;
    state.odometry = test::odometry(now_ns, robot, command.v_m_s, command.yaw_rate_rad_s);
    FollowInput input{now_ns, target, state, obstacles};
    input.searching = searching;
    wanted = law.velocity(input);
    const double a_m_s2 = (command.v_m_s - before_m_s) / kLoop_s;
    before_m_s = command.v_m_s;
    WantedVelocity out = comfort.limited(wanted, command, now_ns);
    if (!std::isfinite(out.v_m_s) || !std::isfinite(out.yaw_rate_rad_s)) out = {};  // as the gate
    longest_jerk_m_s3 =
        std::max(longest_jerk_m_s3, std::abs((out.v_m_s - command.v_m_s) / kLoop_s - a_m_s2) / kLoop_s);
    command.t_issued_ns = now_ns;
    command.t_expires_ns = now_ns + 200 * kNsPerMs;
    command.v_m_s = out.v_m_s;
    command.yaw_rate_rad_s = out.yaw_rate_rad_s;
    robot = test::moved(robot, out.v_m_s, out.yaw_rate_rad_s, kLoop_s);
  }
  void run(double seconds) {
    for (double t_s = 0.0; t_s < seconds; t_s += kLoop_s) tick();
  }
  void look() {
    target = {};
    target.known = true;
    target.t_capture_ns = now_ns;
    const Eigen::Vector2d back_m(person.x_m - kBackBehindAxis_m * std::cos(person.heading_rad),
                                 person.y_m - kBackBehindAxis_m * std::sin(person.heading_rad));
    const Eigen::Vector2d in_robot_m = test::in_robot(robot, back_m.x(), back_m.y());
    target.x_m = in_robot_m.x();
    target.y_m = in_robot_m.y();
    target.travel_yaw_rad = wrap_angle_rad(person.heading_rad - robot.heading_rad);
    target.travel_yaw_sigma_rad = 0.03;
    target.goal_x_m = target.x_m - kSet_m * std::cos(target.travel_yaw_rad);
    target.goal_y_m = target.y_m - kSet_m * std::sin(target.travel_yaw_rad);
    target.body_odom_x_m = person.x_m;
    target.body_odom_y_m = person.y_m;
    target.walk_m_s = person_m_s;
    target.walk_turn_rad_s = person_rad_s;
  }
  double beside_path_m() const {
    double nearest_m = 1e9;
    for (const Pose2& at : path)
      nearest_m = std::min(nearest_m, std::hypot(at.x_m - robot.x_m, at.y_m - robot.y_m));
    return nearest_m;
  }
  double behind_back_m() const {
    return std::hypot(person.x_m - robot.x_m, person.y_m - robot.y_m) - kBackBehindAxis_m;
  }

 private:
  double before_m_s = 0.0;
};

TEST(TrailLaw, FollowsWithoutLagAtConstantSpeed) {
  for (const double v_m_s : {0.3, 0.5, 0.65}) {
    TrailLoop loop;
    loop.person_m_s = v_m_s;
    loop.run(30.0);
    EXPECT_NEAR(loop.behind_back_m(), kSet_m, 0.02) << v_m_s;
    EXPECT_NEAR(loop.robot.y_m, 0.0, 1e-3);
    EXPECT_LE(loop.longest_jerk_m_s3, loop.config.control.jerk_m_s3 + 1e-6);
  }
}

TEST(TrailLaw, WalksRoundABendOnThePersonsOwnPath) {
  for (const double radius_m : {5.0, 3.0, -3.0}) {
    TrailLoop loop;
    loop.person_m_s = 0.5;
    loop.run(10.0);
    loop.person_rad_s = 0.5 / radius_m;
    double worst_m = 0.0;
    for (int i = 0; i < 600; ++i) {
      loop.tick();
      worst_m = std::max(worst_m, loop.beside_path_m());
    }
    EXPECT_LT(worst_m, 0.03) << radius_m;
  }
}

TEST(TrailLaw, ThePictureComesBeforeTheTrail) {
  TrailLoop loop;
  loop.person_m_s = 0.5;
  loop.run(10.0);
  loop.person_rad_s = 0.5;  // a radius of 1 m: on the trail the bearing would be 47 degrees
  double worst_rad = 0.0;
  for (int i = 0; i < 300; ++i) {
    loop.tick();
    worst_rad = std::max(
        worst_rad, std::abs(std::atan2(loop.target.y_m, loop.target.x_m - loop.config.camera.mount_x_m)));
  }
  EXPECT_GT(worst_rad, 0.8 * loop.config.control.trail_bearing_rad);
  EXPECT_LT(worst_rad, loop.config.control.trail_bearing_rad + 0.04);
  EXPECT_GT(loop.beside_path_m(), 0.03);
}

TEST(TrailLaw, SettlesFromBesideTheLine) {
  TrailLoop loop;
  loop.robot = {0.0, 0.5, -30.0 * kRadPerDeg};
  loop.person_m_s = 0.5;
  double settled_s = 0.0, lowest_m = 0.0;
  for (int i = 1; i <= 600; ++i) {
    loop.tick();
    if (std::abs(loop.robot.y_m) > 0.05 || std::abs(loop.robot.heading_rad) > 5.0 * kRadPerDeg)
      settled_s = kLoop_s * i;
    lowest_m = std::min(lowest_m, loop.robot.y_m);
  }
  EXPECT_LT(settled_s, 6.0);
  EXPECT_GT(lowest_m, -0.15 * 0.5);
}

TEST(TrailLaw, RestsBehindAPersonWhoStandsAndDoesNotFollowTheNoise) {
  TrailLoop loop;
  loop.person_m_s = 0.5;
  loop.run(10.0);
  for (; loop.person_m_s > 0.0; loop.person_m_s = std::max(loop.person_m_s - 0.6 * kLoop_s, 0.0)) loop.tick();
  loop.run(4.0);
  EXPECT_NEAR(loop.behind_back_m(), kSet_m, 0.15);
  const Pose2 rest = loop.robot;
  loop.person_m_s = 0.05;  // below the speed of a walk
  for (int i = 0; i < 100; ++i) {
    loop.person_m_s = -loop.person_m_s;
    loop.tick();
  }
  EXPECT_NEAR(loop.robot.x_m, rest.x_m, 0.01);
}

TEST(TrailLaw, GivesWayToAPersonWhoComesNearerWhenItMayReverse) {
  for (const bool reverse : {false, true}) {
    TrailLoop loop;
    loop.config.control.reverse = reverse;
    loop.law.reconfigure(loop.config);
    loop.person_m_s = 0.5;
    loop.run(12.0);
    loop.person_m_s = 0.0;
    loop.run(4.0);
    const double before_m = loop.robot.x_m;
    loop.person_m_s = -0.3;
    loop.run(2.0);
    loop.person_m_s = 0.0;
    loop.run(6.0);
    if (reverse) {
      EXPECT_NEAR(loop.behind_back_m(), kSet_m, 0.15);
      EXPECT_LT(loop.robot.x_m, before_m - 0.3);
      EXPECT_NEAR(loop.robot.y_m, 0.0, 0.02);
    } else {
      EXPECT_NEAR(loop.robot.x_m, before_m, 0.01);
    }
  }
}

TEST(TrailLaw, SearchesAlongTheRestOfTheTrailAndThenToBothSides) {
  TrailLoop loop;
  EXPECT_TRUE(loop.law.may_search());
  loop.person_m_s = 0.5;
  loop.run(10.0);
  loop.person_rad_s = 0.3;
  loop.run(2.0);
  const Pose2 last_seen = loop.person;
  loop.seen = false;
  loop.searching = true;
  bool done = false;
  double most_left_rad = 0.0, most_right_rad = 0.0, fastest_m_s = 0.0, nearest_m = 1e9;
  int first_side = 0;
  for (int i = 0; i < 1500 && !done; ++i) {
    loop.tick();
    done = loop.wanted.search_done;
    nearest_m =
        std::min(nearest_m, std::hypot(last_seen.x_m - loop.robot.x_m, last_seen.y_m - loop.robot.y_m));
    if (i > 100) fastest_m_s = std::max(fastest_m_s, loop.command.v_m_s);
    if (loop.command.v_m_s > 0.01) continue;
    const double turn_rad = wrap_angle_rad(loop.robot.heading_rad - last_seen.heading_rad);
    most_left_rad = std::max(most_left_rad, turn_rad);
    most_right_rad = std::min(most_right_rad, turn_rad);
    if (first_side == 0 && std::abs(turn_rad) > 0.7) first_side = turn_rad > 0.0 ? 1 : -1;
  }
  EXPECT_TRUE(done);
  // Not nearer than the gate lets it come to where the person was.
  const double stop_m = loop.config.gate.separation_m + loop.config.camera.mount_x_m;
  EXPECT_GT(nearest_m, stop_m);
  EXPECT_LT(nearest_m, stop_m + 0.25);
  EXPECT_LE(fastest_m_s, loop.config.control.search_m_s + 1e-9);
  EXPECT_EQ(first_side, 1);  // they were turning left
  EXPECT_GT(most_left_rad, 0.8 * loop.config.control.search_look_rad);
  EXPECT_LT(most_right_rad, -0.8 * loop.config.control.search_look_rad);
  loop.run(1.0);
  EXPECT_TRUE(loop.wanted.search_done);
  EXPECT_EQ(loop.wanted.v_m_s, 0.0);
  EXPECT_EQ(loop.wanted.yaw_rate_rad_s, 0.0);
  // Seen again: a new search begins from the start.
  loop.seen = true;
  loop.searching = false;
  loop.person = test::moved(loop.robot, 2.0, 0.0, 1.0);
  loop.run(0.2);
  loop.searching = true;
  loop.tick();
  EXPECT_FALSE(loop.wanted.search_done);
}

TEST(TrailLaw, ASingleFrameDoesNotMoveTheTrailThatIsSearched) {
  TrailLoop seen_once, never;
  for (TrailLoop* loop : {&seen_once, &never}) {
    loop->person_m_s = 0.5;
    loop->run(10.0);
    loop->seen = false;
    loop->searching = true;
    loop->run(1.0);
    loop->person = test::moved(loop->person, 4.0, 1.0, 1.0);
    loop->seen = loop == &seen_once;
    loop->run(0.1);
    loop->seen = false;
    loop->run(2.0);
  }
  EXPECT_EQ(seen_once.robot.x_m, never.robot.x_m);
  EXPECT_EQ(seen_once.robot.y_m, never.robot.y_m);
}

TEST(TrailLaw, DoesNotSearchWithoutASpeedForIt) {
  Config config;
  config.control.search_m_s = 0.0;
  EXPECT_FALSE(TrailLaw(config).may_search());
}

TEST(TrailLaw, PassesAnObstacleBesideTheTrailWithinItsLimit) {
  TrailLoop loop;
  loop.person_m_s = 0.5;
  loop.run(10.0);
  const double pole_x_m = loop.robot.x_m + 1.0, pole_y_m = 0.25;
  double lowest_m = 0.0;
  for (int i = 0; i < 300; ++i) {
    loop.obstacles = SonarObstacles(robot_models()[0].geometry);
    const Eigen::Vector2d pole_m = test::in_robot(loop.robot, pole_x_m, pole_y_m);
    loop.obstacles.add({pole_m.x(), pole_m.y()});
    loop.tick();
    lowest_m = std::min(lowest_m, loop.robot.y_m);
  }
  EXPECT_LT(lowest_m, -0.05);
  EXPECT_GT(lowest_m, -loop.config.control.detour_m - 0.02);
  loop.run(6.0);
  EXPECT_NEAR(loop.robot.y_m, 0.0, 0.03);  // back on the trail
}

TEST(TrailLaw, GoesOnAfterInputThatIsNotFinite) {
  TrailLoop loop;
  loop.person_m_s = 0.5;
  loop.run(10.0);
  loop.seen = false;
  loop.target.t_capture_ns += 1;
  loop.target.walk_m_s = loop.target.body_odom_x_m = loop.target.travel_yaw_rad = std::nan("");
  loop.tick();
  loop.seen = true;
  loop.run(20.0);
  EXPECT_NEAR(loop.behind_back_m(), kSet_m, 0.05);
}

TEST(TrailLaw, ForgetsTheTrailWhenTheRobotMayHaveMovedUnobserved) {
  TrailLoop loop;
  loop.person_m_s = 0.5;
  loop.run(10.0);
  loop.law.reset();
  loop.seen = false;
  loop.target.known = false;
  loop.tick();
  EXPECT_EQ(loop.wanted.v_m_s, 0.0);
  EXPECT_EQ(loop.wanted.yaw_rate_rad_s, 0.0);
}

}  // namespace
}  // namespace heel
