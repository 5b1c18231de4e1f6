// A back that is turned far is found by views of the template, and a print that only looks alike is refused.
#include <gtest/gtest.h>

#include <cmath>

#include "heel/pose_estimator.h"
#include "support/allocation_count.h"
#include "support/sanitized.h"
#include "vision/pose/average_back.h"
#include "vision/pose/rendered_back.h"

namespace heel {
namespace {

using test::robot_camera;
using test::view_of;

cv::Mat turned_back(const ShirtTemplate& shirt, double yaw_rad, double depth) {
  const BackSurface surface = average_back(ReferenceView(shirt, VisionConfig{}), VisionConfig{});
  const Eigen::Matrix3d R = test::rotation(yaw_rad, 0.0, 0.0);
  return test::render_back(shirt, surface, R, test::t_over_d_for(R, 0.0, depth), 5);
}

TEST(ViewSearch, FindsABackThatIsTurnedFar) {
  const ShirtTemplate taught = test::shirt();
  PoseEstimator estimator(taught, robot_camera(), VisionConfig{});
  VisionConfig plane = test::flat_shirt_config();  // which has no views
  PoseEstimator without_views(taught, robot_camera(), plane);
  int by_views = 0;
  for (const double yaw_rad : {-1.15, -1.05, 1.05, 1.15}) {
    const cv::Mat image = turned_back(taught, yaw_rad, 1.6);
    const PoseEstimate pose = estimator.estimate(view_of(image));
    ASSERT_TRUE(pose.found()) << yaw_rad << ": " << to_string(pose.reason);
    EXPECT_NEAR(pose.yaw_rad, yaw_rad, 0.05);
    EXPECT_NEAR(pose.yaw_rad, yaw_rad, 3.0 * pose.yaw_sigma_rad);
    EXPECT_NEAR(pose.certainty, static_cast<double>(pose.inliers) / pose.template_features, 1e-12);
    by_views += !without_views.estimate(view_of(image)).found();
  }
  EXPECT_GE(by_views, 2) << "the template's own features are enough: this test tests nothing";
}

TEST(ViewSearch, SameFrameSameEstimate) {
  const ShirtTemplate taught = test::shirt();
  const cv::Mat image = turned_back(taught, 1.1, 1.2);
  PoseEstimator one(taught, robot_camera(), VisionConfig{}), two(taught, robot_camera(), VisionConfig{});
  two.estimate(view_of(turned_back(taught, -0.4, 1.5)));
  const PoseEstimate first = one.estimate(view_of(image)), second = two.estimate(view_of(image));
  ASSERT_TRUE(first.found());
  EXPECT_EQ(first.yaw_rad, second.yaw_rad);
  EXPECT_EQ(first.inliers, second.inliers);
}

TEST(ViewSearch, NothingIsFoundInOtherPrints) {
  PoseEstimator estimator(test::shirt(), robot_camera(), VisionConfig{});
  ShirtTemplate other = test::shirt();
  for (std::uint64_t seed = 100; seed < (test::kSanitized ? 103 : 112); ++seed) {
    const cv::Mat print = test::texture(seed, 640, 480);
    other.grey.assign(print.data, print.data + print.total());
    const PoseEstimate pose =
        estimator.estimate(view_of(turned_back(other, 0.1 * static_cast<double>(seed % 7), 1.3)));
    EXPECT_FALSE(pose.found()) << "seed " << seed;
  }
}

TEST(ViewSearch, AllocatesNothing) {
  if (!test::counts_allocations()) GTEST_SKIP() << "a sanitizer owns the allocator";
  const ShirtTemplate taught = test::shirt();
  PoseEstimator estimator(taught, robot_camera(), VisionConfig{});
  const cv::Mat image = turned_back(taught, 1.1, 1.2);
  const std::uint64_t before = test::allocations_of_this_thread();
  const bool found = estimator.estimate(view_of(image)).found();
  EXPECT_EQ(test::allocations_of_this_thread() - before, 0u);
  EXPECT_TRUE(found);
}

}  // namespace
}  // namespace heel
