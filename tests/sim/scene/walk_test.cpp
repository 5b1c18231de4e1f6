// The walked path against plane geometry.
#include "sim/scene/walk.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "heel/error.h"

namespace heel::sim {
namespace {

constexpr double kPi = std::numbers::pi;

WalkItem straight(double length_m, double speed_m_s) {
  WalkItem item;
  item.length_m = length_m;
  item.speed_m_s = speed_m_s;
  return item;
}

WalkItem arc(double radius_m, double angle_rad) {
  WalkItem item;
  item.step = WalkStep::Arc;
  item.radius_m = radius_m;
  item.angle_rad = angle_rad;
  return item;
}

TEST(Walk, EndsWhereGeometrySays) {
  WalkState start;
  start.heading_rad = kPi / 2;
  const Walk walk(start, {straight(2, 0.5), arc(3, kPi / 2), straight(1, 0.5)});
  const WalkState end = walk.at(walk.duration_s() + 5);
  EXPECT_NEAR(end.x_m, -3 - 1, 1e-6);
  EXPECT_NEAR(end.y_m, 2 + 3, 1e-6);
  EXPECT_NEAR(end.heading_rad, kPi, 1e-9);
  EXPECT_EQ(end.speed_m_s, 0.0);
}

TEST(Walk, RightBendTurnsClockwise) {
  const Walk walk(WalkState{}, {arc(2, -kPi / 2)});
  const WalkState end = walk.at(1e3);
  EXPECT_NEAR(end.x_m, 2, 1e-6);
  EXPECT_NEAR(end.y_m, -2, 1e-6);
}

TEST(Walk, ReachesWaypointsOnEverySide) {
  for (int i = 0; i < 12; ++i) {
    WalkItem to;
    to.step = WalkStep::To;
    to.x_m = 3 * std::cos(i * kPi / 6 + 0.1);
    to.y_m = 3 * std::sin(i * kPi / 6 + 0.1);
    const Walk walk(WalkState{}, {to});
    const WalkState end = walk.at(1e3);
    EXPECT_NEAR(end.x_m, to.x_m, 1e-6) << i;
    EXPECT_NEAR(end.y_m, to.y_m, 1e-6) << i;
    EXPECT_LT(walk.duration_s() * to.speed_m_s, 9.0) << i;  // no needless circle
  }
}

TEST(Walk, RefusesAWaypointInsideItsTurningCircle) {
  WalkItem to;
  to.step = WalkStep::To;
  to.y_m = 0.5;
  EXPECT_THROW(Walk(WalkState{}, {to}), Error);
}

TEST(Walk, AccelerationIsBoundedAndSpeedReached) {
  WalkItem pause;
  pause.step = WalkStep::Pause;
  pause.duration_s = 1;
  const Walk walk(WalkState{}, {straight(3, 0.8), straight(3, 0.4), pause, straight(2, 0.5)});
  double fastest = 0;
  for (double t = 0; t < walk.duration_s(); t += 0.05) {
    const double v0 = walk.at(t).speed_m_s;
    const double v1 = walk.at(t + 0.05).speed_m_s;
    EXPECT_LE(std::abs(v1 - v0), 0.6 * 0.05 + 0.1) << t;
    const double moved =
        std::hypot(walk.at(t + 0.05).x_m - walk.at(t).x_m, walk.at(t + 0.05).y_m - walk.at(t).y_m);
    EXPECT_LE(moved, 0.8 * 0.05 + 1e-9) << t;
    fastest = std::max(fastest, v0);
  }
  EXPECT_NEAR(fastest, 0.8, 1e-6);
}

TEST(Walk, GaitPhaseRunsOnlyWhileMoving) {
  WalkItem pause;
  pause.step = WalkStep::Pause;
  pause.duration_s = 2;
  const Walk walk(WalkState{}, {straight(2, 0.5), pause});
  const double end = walk.duration_s();
  EXPECT_GT(walk.at(end - 2).stride_rad, 2 * kPi);
  EXPECT_EQ(walk.at(end - 1.9).stride_rad, walk.at(end).stride_rad);
}

WalkItem of(WalkStep step, double length_m, double duration_s) {
  WalkItem item;
  item.step = step;
  item.length_m = length_m;
  item.duration_s = duration_s;
  return item;
}

TEST(Walk, AsideAndBackwardsKeepTheHeading) {
  WalkState start;
  start.heading_rad = kPi / 2;
  const Walk walk(start, {straight(2, 0.5), of(WalkStep::Aside, 1.0, 0), of(WalkStep::Back, 1.5, 0),
                          of(WalkStep::Aside, -0.25, 0)});
  for (double t = 0; t < walk.duration_s(); t += 0.1) {
    EXPECT_EQ(walk.at(t).heading_rad, kPi / 2);
    EXPECT_GE(walk.at(t).speed_m_s, 0.0);
  }
  const WalkState end = walk.at(1e3);
  EXPECT_NEAR(end.x_m, -0.75, 1e-6);  // left of north is west
  EXPECT_NEAR(end.y_m, 0.5, 1e-6);
}

TEST(Walk, StopsBetweenAheadAndBackwards) {
  const Walk walk(WalkState{}, {straight(2, 0.8), of(WalkStep::Back, 2, 0)});
  double slowest = 1;
  double before_x = 0;
  for (double t = 0; t < walk.duration_s(); t += 0.01) {
    const WalkState state = walk.at(t);
    EXPECT_LT(std::abs(state.x_m - before_x), 0.009) << t;
    before_x = state.x_m;
    if (state.x_m > 1.99) slowest = std::min(slowest, state.speed_m_s);
  }
  EXPECT_LT(slowest, 0.05);
  EXPECT_NEAR(walk.at(1e3).x_m, 0.0, 1e-6);
  // Steps run backwards too.
  EXPECT_LT(walk.at(walk.duration_s()).stride_rad, walk.at(0.5 * walk.duration_s()).stride_rad);
}

TEST(Walk, SitsOnAStoolBehindAndGetsUp) {
  const Walk walk(WalkState{}, {straight(2, 0.5), of(WalkStep::Sit, 0, 8), straight(1, 0.5)});
  ASSERT_EQ(walk.stools().size(), 1U);
  EXPECT_NEAR(walk.stools()[0].x_m, 2.0 - kSeatBehindFeet_m, 1e-6);
  double highest = 0, before = 0;
  for (double t = 0; t < walk.duration_s(); t += 0.01) {
    const double seat = walk.at(t).seat;
    EXPECT_LT(std::abs(seat - before), 0.02) << t;
    before = seat;
    highest = std::max(highest, seat);
  }
  EXPECT_NEAR(highest, 1.0, 1e-9);
  EXPECT_EQ(walk.at(1e3).seat, 0.0);
  EXPECT_NEAR(walk.at(1e3).x_m, 3.0, 1e-6);
}

}  // namespace
}  // namespace heel::sim
