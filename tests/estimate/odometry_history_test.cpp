#include "estimate/odometry_history.h"

#include <gtest/gtest.h>

#include "estimate/floor_truth.h"

namespace heel {
namespace {

Odometry at_time(TimeNs t_ns, double x_m, double heading_rad = 0.0) {
  return {t_ns, x_m, 0.0, heading_rad, 0.0, 0.0};
}

TEST(OdometryHistory, HasNoPoseWhenEmpty) {
  EXPECT_FALSE(OdometryHistory().pose_at(0).has_value());
}

TEST(OdometryHistory, InterpolatesBetweenPackets) {
  OdometryHistory history;
  history.add(at_time(100, 1.0, 3.0));
  history.add(at_time(200, 2.0, 3.4));  // headings are continuous: no wrap in between
  const auto pose = history.pose_at(125);
  ASSERT_TRUE(pose.has_value());
  EXPECT_DOUBLE_EQ(pose->x_m, 1.25);
  EXPECT_DOUBLE_EQ(pose->heading_rad, 3.1);
  EXPECT_DOUBLE_EQ(history.pose_at(100)->x_m, 1.0);
  EXPECT_DOUBLE_EQ(history.pose_at(200)->x_m, 2.0);
}

TEST(OdometryHistory, ExtrapolatesAlongTheArcAfterTheNewest) {
  OdometryHistory history;
  const Pose2 start{1.0, 2.0, 0.5};
  history.add(test::odometry(kNsPerS, start, 0.7, 1.5));
  const Pose2 expected = test::moved(start, 0.7, 1.5, 0.3);
  const auto pose = history.pose_at(kNsPerS + 300 * kNsPerMs);
  ASSERT_TRUE(pose.has_value());
  EXPECT_NEAR(pose->x_m, expected.x_m, 1e-12);
  EXPECT_NEAR(pose->y_m, expected.y_m, 1e-12);
  EXPECT_NEAR(pose->heading_rad, expected.heading_rad, 1e-12);
}

TEST(OdometryHistory, RefusesTooFarAheadAndTooOld) {
  OdometryHistory history;
  history.add(at_time(kNsPerS, 0.0));
  EXPECT_TRUE(history.pose_at(kNsPerS + OdometryHistory::kMaxAhead_ns).has_value());
  EXPECT_FALSE(history.pose_at(kNsPerS + OdometryHistory::kMaxAhead_ns + 1).has_value());
  EXPECT_FALSE(history.pose_at(kNsPerS - 1).has_value());
}

TEST(OdometryHistory, DropsOnlyTheOldestWhenFull) {
  OdometryHistory history;
  const auto count = static_cast<TimeNs>(OdometryHistory::kCapacity) + 10;
  for (TimeNs i = 0; i < count; ++i) history.add(at_time(i * 100, static_cast<double>(i)));
  for (TimeNs i = 10; i < count; ++i) EXPECT_DOUBLE_EQ(history.pose_at(i * 100)->x_m, static_cast<double>(i));
  EXPECT_FALSE(history.pose_at(9 * 100).has_value());
}

TEST(OdometryHistory, IgnoresPacketsThatAreNotNewer) {
  OdometryHistory history;
  history.add(at_time(100, 1.0));
  history.add(at_time(100, 5.0));
  history.add(at_time(50, 6.0));
  EXPECT_DOUBLE_EQ(history.pose_at(100)->x_m, 1.0);
  EXPECT_FALSE(history.pose_at(50).has_value());
}

}  // namespace
}  // namespace heel
