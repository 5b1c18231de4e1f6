// Unwrapping, units, damaged and zeroed counters, against paths known in advance.
#include "robot/odometry.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "models/robot_models.h"

namespace heel {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr TimeNs kCycle_ns = 100 * kNsPerMs;

/// A robot's counters for a true pose, in the forms that different firmware uses.
struct Counters {
  double mm_per_unit = 1.0;
  unsigned position_mask = 0xFFFF;  // natural wrap, or 0x7FFF
  bool heading_from_zero = false;   // 0…4095 instead of −2048…2047

  arcos::Sip at(double x_m, double y_m, double heading_rad) const {
    arcos::Sip sip;
    const auto position = [this](double m) {
      return static_cast<std::uint16_t>(static_cast<unsigned>(std::lround(m * 1000.0 / mm_per_unit)) &
                                        position_mask);
    };
    sip.x_pos = position(x_m);
    sip.y_pos = position(y_m);
    const long units = std::lround(heading_rad * 4096.0 / (2.0 * kPi)) & 0xFFF;
    sip.th_pos = static_cast<std::int16_t>(!heading_from_zero && units >= 2048 ? units - 4096 : units);
    return sip;
  }
};

/// A P3-AT with another unit of position.
RobotModel p3at_of(double mm_per_unit) {
  RobotModel model = robot_models()[0];
  model.mm_per_position_unit = mm_per_unit;
  return model;
}

TEST(Odometry, FollowsACircleThroughManyWraps) {
  for (const Counters& counters : {Counters{}, Counters{1.0, 0x7FFF, true}, Counters{0.465, 0xFFFF, true},
                                   Counters{0.465, 0x7FFF, false}}) {
    OdometryTracker odometry(p3at_of(counters.mm_per_unit));
    // A circle of 40 m radius, wider than either wrap, three times round at 1 m/s.
    const double radius_m = 40.0;
    TimeNs t_ns = 0;
    for (double arc_m = 0.0; arc_m < 3 * 2.0 * kPi * radius_m; arc_m += 0.1) {
      const double heading_rad = arc_m / radius_m;
      const double x_m = radius_m * std::sin(heading_rad);
      const double y_m = radius_m * (1.0 - std::cos(heading_rad));
      t_ns += kCycle_ns;
      ASSERT_EQ(odometry.update(counters.at(x_m, y_m, heading_rad), t_ns), OdometryTracker::Step::Moved);
      ASSERT_NEAR(odometry.pose().x_m, x_m, 1e-3);
      ASSERT_NEAR(odometry.pose().y_m, y_m, 1e-3);
      ASSERT_NEAR(odometry.pose().heading_rad, heading_rad, 1e-3);
      ASSERT_EQ(odometry.pose().t_ns, t_ns);
    }
  }
}

TEST(Odometry, StartsAtTheOriginWhateverTheCountersShow) {
  OdometryTracker odometry(p3at_of(1.0));
  odometry.update(Counters{}.at(5.0, -3.0, kPi / 2), 0);
  EXPECT_EQ(odometry.pose().x_m, 0.0);
  EXPECT_EQ(odometry.pose().heading_rad, 0.0);
  odometry.update(Counters{}.at(5.0, -2.9, kPi / 2), kCycle_ns);  // ahead, for this robot
  EXPECT_NEAR(odometry.pose().x_m, 0.1, 1e-9);
  EXPECT_NEAR(odometry.pose().y_m, 0.0, 1e-9);
}

struct Standing {
  OdometryTracker odometry{p3at_of(1.0)};
  TimeNs t_ns = 0;
  OdometryTracker::Step step(double x_m, double y_m, double heading_rad) {
    t_ns += kCycle_ns;
    return odometry.update(Counters{}.at(x_m, y_m, heading_rad), t_ns);
  }
  /// Origin, then 3 m ahead and turned to the left.
  Standing() {
    for (int i = 0; i <= 30; ++i) step(0.1 * i, 0.0, 0.0);
    for (int i = 0; i <= 9; ++i) step(3.0, 0.0, i * kPi / 18);
  }
  void expect_pose(double x_m, double y_m, double heading_rad) {
    EXPECT_NEAR(odometry.pose().x_m, x_m, 2e-3);
    EXPECT_NEAR(odometry.pose().y_m, y_m, 2e-3);
    EXPECT_NEAR(odometry.pose().heading_rad, heading_rad, 2e-3);
  }
};

TEST(OdometryJumps, OneDamagedSipIsIgnored) {
  Standing robot;
  EXPECT_EQ(robot.step(7.0, 0.0, kPi / 2), OdometryTracker::Step::Suspect);
  robot.expect_pose(3.0, 0.0, kPi / 2);
  EXPECT_EQ(robot.step(3.0, 0.05, kPi / 2), OdometryTracker::Step::Moved);
  robot.expect_pose(3.0, 0.05, kPi / 2);
  EXPECT_EQ(robot.step(3.0, 0.05, -kPi / 2),
            OdometryTracker::Step::Suspect);  // the heading alone is suspect too
  EXPECT_EQ(robot.step(3.0, 0.05, kPi / 2), OdometryTracker::Step::Moved);
  robot.expect_pose(3.0, 0.05, kPi / 2);
}

TEST(OdometryJumps, AConfirmedJumpRebasesTheOdometry) {
  Standing robot;
  EXPECT_EQ(robot.step(0.0, 0.0, 0.0), OdometryTracker::Step::Suspect);  // SETO from another client
  EXPECT_EQ(robot.step(0.05, 0.0, 0.0), OdometryTracker::Step::Rebased);
  robot.expect_pose(3.0, 0.05, kPi / 2);  // its x axis is y of our odometry frame
  EXPECT_EQ(robot.step(0.1, 0.0, 0.0), OdometryTracker::Step::Moved);
  robot.expect_pose(3.0, 0.1, kPi / 2);
}

TEST(OdometryInterruption, CountersThatContinuedAreUsed) {
  Standing robot;
  robot.odometry.interrupted();
  robot.t_ns += 5 * kNsPerS;
  EXPECT_EQ(robot.step(3.0, 0.4, kPi / 2), OdometryTracker::Step::Moved);  // it rolled on meanwhile
  robot.expect_pose(3.0, 0.4, kPi / 2);
}

TEST(OdometryInterruption, CountersNearZeroBeforeAndAfterWereNotZeroed) {
  OdometryTracker odometry(p3at_of(1.0));
  odometry.update(Counters{}.at(0.0, 0.0, 0.0), 0);
  odometry.update(Counters{}.at(0.01, 0.0, 0.0), kCycle_ns);
  odometry.interrupted();
  EXPECT_EQ(odometry.update(Counters{}.at(0.04, 0.0, 0.0), kNsPerS), OdometryTracker::Step::Moved);
  EXPECT_NEAR(odometry.pose().x_m, 0.04, 1e-9);
}

TEST(OdometryInterruption, ZeroedCountersContinueThePose) {
  Standing robot;
  robot.odometry.interrupted();
  robot.t_ns += 60 * kNsPerS;
  EXPECT_EQ(robot.step(0.0, 0.0, 0.0), OdometryTracker::Step::Rebased);
  robot.expect_pose(3.0, 0.0, kPi / 2);
  robot.step(0.1, 0.0, 0.1);
  robot.expect_pose(3.0, 0.1, kPi / 2 + 0.1);
}

TEST(OdometryInterruption, ControllerResetContinuesThePoseEvenNearby) {
  Standing robot;
  robot.odometry.controller_reset();
  EXPECT_EQ(robot.step(2.9, 0.0, kPi / 2), OdometryTracker::Step::Rebased);
  robot.expect_pose(3.0, 0.0, kPi / 2);
}

TEST(Odometry, SpeedsFromTheWheels) {
  OdometryTracker odometry(p3at_of(1.0));
  arcos::Sip sip;
  sip.left_mm_s = -100;
  sip.right_mm_s = 194;
  odometry.update(sip, 0);
  EXPECT_DOUBLE_EQ(odometry.pose().v_m_s, 0.047);
  EXPECT_NEAR(odometry.pose().yaw_rate_rad_s, 0.5, 1e-12);  // 294 mm/s over 588 mm
}

}  // namespace
}  // namespace heel
