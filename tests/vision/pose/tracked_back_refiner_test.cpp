// From frame to frame a back is read as a back and a board as a board, whatever the last frame's pose says.
#include <gtest/gtest.h>

#include "heel/pose_estimator.h"
#include "support/allocation_count.h"
#include "support/sanitized.h"
#include "vision/pose/average_back.h"
#include "vision/pose/rendered_back.h"

namespace heel {
namespace {

using test::robot_camera;

constexpr TimeNs kNextFrame_ns = kNsPerS / 30;

class TrackedBack : public ::testing::Test {
 protected:
  cv::Mat seen(const BackSurface& surface, double yaw_rad) const {
    const Eigen::Matrix3d R = test::rotation(yaw_rad, 0.03, 0.0);
    return test::render_back(taught_, surface, R, test::t_over_d_for(R, 0.05, 1.0), 5);
  }
  /// The pose of `image` after a frame with the pose `last`.
  PoseEstimate tracked(const cv::Mat& image, const PoseEstimate& last) {
    ExpectedView expected = estimator_.expected_view(last, last.t_capture_ns + kNextFrame_ns);
    expected.tracking = true;
    return estimator_.estimate(test::view_of(image), expected);
  }

  const ShirtTemplate taught_ = test::shirt();
  const ReferenceView reference_{taught_, VisionConfig{}};
  const BackSurface back_ = average_back(reference_, VisionConfig{});
  const BackSurface board_ = flat_surface(reference_, VisionConfig{});
  PoseEstimator estimator_{taught_, robot_camera(), VisionConfig{}};
};

TEST_F(TrackedBack, IsFollowedWhileItTurns) {
  PoseEstimate last = estimator_.estimate(test::view_of(seen(back_, -0.5)));
  ASSERT_TRUE(last.found());
  for (double yaw_rad = -0.4; yaw_rad < (test::kSanitized ? -0.15 : 0.55); yaw_rad += 0.1) {
    last = tracked(seen(back_, yaw_rad), last);
    ASSERT_TRUE(last.found()) << yaw_rad;
    EXPECT_NEAR(last.yaw_rad, yaw_rad, 0.02);
  }
}

TEST_F(TrackedBack, IsFoundAgainAfterALastPoseThatWasWrong) {
  PoseEstimate last = estimator_.estimate(test::view_of(seen(back_, -0.6)));
  ASSERT_TRUE(last.found());
  const cv::Mat image = seen(back_, 0.5);
  const PoseEstimate pose = tracked(image, last);
  ASSERT_TRUE(pose.found());
  EXPECT_NEAR(pose.yaw_rad, 0.5, 0.02);
}

TEST_F(TrackedBack, ABoardIsReadAsOne) {
  for (const double yaw_rad : {-0.6, -0.35, 0.35, 0.6}) {
    const cv::Mat image = seen(board_, yaw_rad);
    const PoseEstimate first = estimator_.estimate(test::view_of(image));
    ASSERT_TRUE(first.found()) << yaw_rad;
    EXPECT_NEAR(first.yaw_rad, yaw_rad, 0.01) << "searched";
    const PoseEstimate next = tracked(image, first);
    ASSERT_TRUE(next.found()) << yaw_rad;
    EXPECT_NEAR(next.yaw_rad, yaw_rad, 0.01) << "tracked";
  }
}

TEST_F(TrackedBack, AllocatesNothing) {
  if (!test::counts_allocations()) GTEST_SKIP() << "a sanitizer owns the allocator";
  const cv::Mat image = seen(back_, 0.2);
  const PoseEstimate last = estimator_.estimate(test::view_of(image));
  const std::uint64_t before = test::allocations_of_this_thread();
  const PoseEstimate pose = tracked(image, last);
  EXPECT_EQ(test::allocations_of_this_thread() - before, 0u);
  EXPECT_TRUE(pose.found());
}

}  // namespace
}  // namespace heel
