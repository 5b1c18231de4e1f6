// A camera's pose estimate becomes a measurement on the floor; compared with poses from X_cur = R X_ref + t.
#include "estimate/target_measurement.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <limits>

#include "estimate/floor_truth.h"

namespace heel {
namespace {

TEST(RobotFromCamera, AxesOfALevelCamera) {
  const Eigen::Matrix3d R = R_robot_from_camera({});
  EXPECT_TRUE((R * Eigen::Vector3d::UnitZ()).isApprox(Eigen::Vector3d(1, 0, 0)));  // optical axis: ahead
  EXPECT_TRUE(
      (R * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d(0, -1, 0)));  // image right: robot's right
  EXPECT_TRUE((R * Eigen::Vector3d::UnitY()).isApprox(Eigen::Vector3d(0, 0, -1)));  // image down: down
}

TEST(RobotFromCamera, PositivePitchLooksUpAndStaysARotation) {
  const Eigen::Matrix3d R = R_robot_from_camera({.pitch_rad = 0.3});
  EXPECT_GT((R * Eigen::Vector3d::UnitZ()).z(), 0.0);
  EXPECT_TRUE((R.transpose() * R).isApprox(Eigen::Matrix3d::Identity()));
  EXPECT_NEAR(R.determinant(), 1.0, 1e-12);
}

TEST(TargetMeasurement, PersonAheadTurnedToTheImagesRightIsAClockwiseYaw) {
  const CameraMount mount;
  const auto pose = test::measured({3.0, 0.0, -0.5}, {}, mount, {});
  EXPECT_NEAR(pose.yaw_rad, 0.5, 1e-12);  // the image's convention
  const auto measurement = measurement_from_pose(pose, mount);
  ASSERT_TRUE(measurement.has_value());
  EXPECT_NEAR(measurement->yaw_rad, -0.5, 1e-12);  // the robot's
}

double between(double low, double high) {
  return low + (high - low) * *rc::gen::inRange(0, 1000001) / 1e6;
}

RC_GTEST_PROP(TargetMeasurement, RecoversThePersonForEveryMountAndTemplate, ()) {
  CameraMount mount;
  mount.x_m = between(-0.5, 0.5);
  mount.y_m = between(-0.3, 0.3);
  mount.z_m = between(0.2, 1.5);
  mount.pitch_rad = between(-0.5, 0.5);
  mount.yaw_rad = between(-0.5, 0.5);
  mount.roll_rad = between(-0.5, 0.5);
  const test::Reference reference{{between(-0.3, 0.3), between(-0.3, 0.3), between(1.0, 4.0)}};
  const Pose2 person{between(1.0, 6.0), between(-2.0, 2.0), between(-1.2, 1.2)};
  // The camera sees the back, not the front: the plane of the back is ahead of it.
  const Eigen::Vector2d walking(std::cos(person.heading_rad), std::sin(person.heading_rad));
  const Eigen::Vector2d from_camera_m(person.x_m - mount.x_m, person.y_m - mount.y_m);
  RC_PRE(walking.dot(from_camera_m) > 0.05);
  const auto measurement = measurement_from_pose(test::measured(person, {}, mount, reference), mount);
  RC_ASSERT(measurement.has_value());
  RC_ASSERT(std::abs(measurement->position_m.x() - person.x_m) < 1e-9);
  RC_ASSERT(std::abs(measurement->position_m.y() - person.y_m) < 1e-9);
  RC_ASSERT(std::abs(measurement->yaw_rad - person.heading_rad) < 1e-9);
  RC_ASSERT(std::abs(measurement->in_reference_view_m.x() - reference.distance_m()) < 1e-9);
  RC_ASSERT(std::abs(measurement->in_reference_view_m.y() + reference.centre_m.x()) < 1e-9);
}

TEST(TargetMeasurement, RefusesAPlaneSeenFromTheFront) {
  const CameraMount mount = mount_of(CameraConfig{});
  const Pose2 facing_us{3.0, 0.0, 3.0};
  EXPECT_FALSE(measurement_from_pose(test::measured(facing_us, {}, mount, {}), mount).has_value());
}

TEST(TargetMeasurement, RefusesPosesThatCannotBeUsed) {
  const CameraMount mount;
  const PoseEstimate good = test::measured({3.0, 0.2, 0.1}, {}, mount, {});
  ASSERT_TRUE(measurement_from_pose(good, mount).has_value());

  PoseEstimate pose = good;
  pose.reason = PoseReason::TooFewInliers;
  EXPECT_FALSE(measurement_from_pose(pose, mount).has_value());
  pose = good;
  pose.has_distance = false;
  EXPECT_FALSE(measurement_from_pose(pose, mount).has_value());
  pose = good;
  pose.position_m[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(measurement_from_pose(pose, mount).has_value());
  pose = good;
  pose.frame_yaw_sigma_rad = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(measurement_from_pose(pose, mount).has_value());
  pose = good;
  pose.R_cur_from_ref = {1, 0, 0, 0, 0, 1, 0, -1, 0};  // the back lies flat: no direction on the floor
  EXPECT_FALSE(measurement_from_pose(pose, mount).has_value());
}

}  // namespace
}  // namespace heel
