// The whole vision stage on rendered frames: a printed plane through two different lenses, both with
// distortion.
#include "heel/pose_estimator.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <cstring>
#include <opencv2/imgproc.hpp>
#include <set>

#include "heel/error.h"
#include "heel/motion.h"
#include "support/allocation_count.h"
#include "support/pose_bytes.h"
#include "support/sanitized.h"
#include "vision/pose/rendered_shirt.h"
#include "vision/pose/scene.h"

namespace heel {
namespace {

using test::flat_shirt_config;
using test::homography;
using test::render;
using test::robot_camera;
using test::shirt;
using test::t_over_d_for;
using test::texture;
using test::view_of;

TEST(PoseEstimator, FindsYawTranslationAndPositionThroughTwoLenses) {
  const ShirtTemplate taught = shirt();
  PoseEstimator estimator(taught, robot_camera(), flat_shirt_config());
  double squared_yaw = 0.0, worst_deg = 0.0;
  int views = 0;
  for (const double yaw_deg : {-40.0, -30.0, -20.0, -8.0, 0.0, 8.0, 20.0, 30.0, 40.0}) {
    for (const double depth : {0.7, 1.0, 1.6}) {
      const Eigen::Matrix3d R = test::rotation(yaw_deg * M_PI / 180.0, 0.03, -0.02);
      const Eigen::Vector3d t = t_over_d_for(R, 0.08, depth);
      const Eigen::Matrix3d H = homography(R, t);
      const cv::Mat frame = render(taught, H, 900 + static_cast<std::uint64_t>(views));
      const PoseEstimate pose = estimator.estimate(view_of(frame));
      ASSERT_TRUE(pose.found()) << yaw_deg << " deg, depth " << depth << ": " << to_string(pose.reason);
      ++views;
      EXPECT_GT(pose.certainty, 0.08) << yaw_deg << " deg, depth " << depth;
      EXPECT_EQ(pose.frame_sequence, 42u);
      EXPECT_EQ(pose.t_capture_ns, 123456789);
      EXPECT_EQ(pose.t_done_ns, 0);
      const double error_deg = pose.yaw_rad * 180.0 / M_PI - yaw_deg;
      worst_deg = std::max(worst_deg, std::abs(error_deg));
      squared_yaw += std::pow(error_deg * M_PI / 180.0 / pose.yaw_sigma_rad, 2);
      for (int i = 0; i < 3; ++i) {
        const auto axis = static_cast<std::size_t>(i);
        EXPECT_NEAR(pose.t_over_d[axis], t(i), 5.0 * pose.t_over_d_sigma[axis] + 0.003)
            << yaw_deg << " deg, depth " << depth << ", axis " << i;
      }
      const Eigen::Vector2d centre = taught.camera.undistort_px({319.5, 239.5});
      const Eigen::Vector3d truth = 2.0 * (R * taught.camera.K().inverse() * centre.homogeneous() + t);
      ASSERT_TRUE(pose.has_distance);
      EXPECT_LT((Eigen::Vector3d(pose.position_m.data()) - truth).norm(), 0.02 * truth.norm());
      const Eigen::Matrix3d found =
          Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(pose.H_cur_from_ref.data());
      EXPECT_LT(test::corner_error_px(found, H), 2.0) << yaw_deg << " deg, depth " << depth;
    }
  }
  std::cout << "worst yaw error " << worst_deg << " deg, normalised error squared " << squared_yaw / views
            << "\n";
  EXPECT_LT(worst_deg, 3.0);
  EXPECT_LT(squared_yaw / views, 4.0);
}

TEST(PoseEstimator, ReferenceViewItselfIsFoundWithoutMotion) {
  ShirtTemplate taught = shirt();
  PoseEstimator estimator(taught, taught.camera, flat_shirt_config());
  const cv::Mat same(480, 640, CV_8U, taught.grey.data());
  const PoseEstimate pose = estimator.estimate(view_of(same));
  ASSERT_TRUE(pose.found()) << to_string(pose.reason);
  EXPECT_NEAR(pose.yaw_rad, 0.0, 0.01);
  EXPECT_GT(pose.certainty, 0.6);
  EXPECT_NEAR(pose.position_m[2], 2.0, 0.01);
}

TEST(PoseEstimator, WithoutDistanceThereAreNoMetres) {
  ShirtTemplate taught = shirt();
  taught.distance_m = 0.0;
  PoseEstimator estimator(taught, robot_camera(), flat_shirt_config());
  const Eigen::Matrix3d R = test::rotation(0.2, 0.0, 0.0);
  const PoseEstimate pose =
      estimator.estimate(view_of(render(taught, homography(R, t_over_d_for(R, 0.0, 1.2)), 5)));
  ASSERT_TRUE(pose.found());
  EXPECT_FALSE(pose.has_distance);
  EXPECT_EQ(pose.position_m[2], 0.0);
  EXPECT_NEAR(pose.yaw_rad, 0.2, 0.04);
}

TEST(PoseEstimator, SameFrameSameEstimateToTheBit) {
  const ShirtTemplate taught = shirt();
  PoseEstimator one(taught, robot_camera(), flat_shirt_config()),
      two(taught, robot_camera(), flat_shirt_config());
  const Eigen::Matrix3d R = test::rotation(-0.3, 0.0, 0.0);
  const cv::Mat frame = render(taught, homography(R, t_over_d_for(R, 0.0, 1.2)), 5);
  const PoseEstimate first = one.estimate(view_of(frame));
  two.estimate(view_of(texture(77, 640, 480)));  // earlier frames have no effect
  const PoseEstimate second = two.estimate(view_of(frame));
  ASSERT_TRUE(first.found());
  EXPECT_EQ(test::pose_bytes(first), test::pose_bytes(second));
}

TEST(PoseEstimator, ClutterIsNeverTheShirt) {
  PoseEstimator estimator(shirt(), robot_camera(), flat_shirt_config());
  std::set<PoseReason> reasons;
  for (std::uint64_t seed = 1000; seed < (test::kThreadSanitizer ? 1010 : 1200); ++seed) {
    const PoseEstimate pose = estimator.estimate(view_of(texture(seed, 640, 480)));
    EXPECT_FALSE(pose.found()) << "seed " << seed << ": " << pose.inliers << " inliers";
    reasons.insert(pose.reason);
  }
  EXPECT_TRUE(reasons.contains(PoseReason::TooFewInliers) || reasons.contains(PoseReason::NoHomography));
}

TEST(PoseEstimator, RefusalsAreNamed) {
  const ShirtTemplate taught = shirt();
  PoseEstimator estimator(taught, robot_camera(), flat_shirt_config());
  EXPECT_EQ(estimator.estimate(view_of(cv::Mat::zeros(480, 640, CV_8U))).reason, PoseReason::TooFewFeatures);
  EXPECT_EQ(estimator.estimate(view_of(texture(3, 320, 240))).reason, PoseReason::WrongFrameSize);

  cv::Mat dots(480, 640, CV_8U, cv::Scalar(200));
  for (int i = 0; i < 5; ++i) cv::circle(dots, {100 + 100 * i, 200 + 15 * i}, 6, 20, -1, cv::LINE_AA);
  EXPECT_EQ(estimator.estimate(view_of(dots)).reason, PoseReason::TooFewMatches);

  // Enough matches, but at a size that the shirt cannot have at the allowed distances.
  VisionConfig narrow = flat_shirt_config();
  narrow.distance_min_m = 0.6;
  narrow.distance_max_m = 0.8;
  PoseEstimator near_only(taught, robot_camera(), narrow);
  const Eigen::Matrix3d R = test::rotation(0.1, 0.0, 0.0);
  const cv::Mat far = render(taught, homography(R, t_over_d_for(R, 0.0, 1.3)), 5);
  ASSERT_TRUE(estimator.estimate(view_of(far)).found());
  const PoseEstimate refused = near_only.estimate(view_of(far));
  EXPECT_FALSE(refused.found());

  VisionConfig demanding = flat_shirt_config();
  demanding.min_certainty = 0.99;
  EXPECT_EQ(PoseEstimator(taught, robot_camera(), demanding).estimate(view_of(far)).reason,
            PoseReason::TooFewInliers);
}

TEST(PoseEstimator, ConstructorRefusesATemplateThatCannotBeFollowed) {
  ShirtTemplate plain = shirt();
  std::fill(plain.grey.begin(), plain.grey.end(), std::uint8_t{128});
  EXPECT_THROW(PoseEstimator(plain, robot_camera(), VisionConfig{}), Error);
  EXPECT_THROW(PoseEstimator(shirt(), CameraModel{}, VisionConfig{}), Error);
}

TEST(PoseEstimator, AllocatesNothingAfterConstruction) {
  if (!test::counts_allocations()) GTEST_SKIP() << "a sanitizer owns the allocator";
  const ShirtTemplate taught = shirt();
  PoseEstimator estimator(taught, robot_camera(), VisionConfig{});
  const Eigen::Matrix3d R = test::rotation(0.3, 0.0, 0.0);
  const cv::Mat frame = render(taught, homography(R, t_over_d_for(R, 0.0, 1.2)), 5);
  const cv::Mat clutter = texture(9, 640, 480);
  const std::uint64_t before = test::allocations_of_this_thread();
  const bool found = estimator.estimate(view_of(frame)).found();
  estimator.estimate(view_of(clutter));
  EXPECT_EQ(test::allocations_of_this_thread() - before, 0u);
  EXPECT_TRUE(found);
}

}  // namespace
}  // namespace heel
