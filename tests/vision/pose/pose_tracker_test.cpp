// Tracking loses no detection and no accuracy against a search of the whole frame.
#include "heel/pose_tracker.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <iostream>

#include "support/allocation_count.h"
#include "support/pose_bytes.h"
#include "support/sanitized.h"
#include "vision/pose/average_back.h"
#include "vision/pose/frame_sequence.h"
#include "vision/pose/rendered_back.h"

namespace heel {
namespace {

using test::flat_shirt_config;
using test::frame_at;
using test::homography;
using test::kFramePeriod_ns;
using test::render;
using test::robot_camera;
using test::shirt;
using test::t_over_d_for;
using test::texture;

/// A view of the back at `x` template distances to the side.
cv::Mat seen(const ShirtTemplate& taught, double yaw_rad, double x, double depth, std::uint64_t clutter = 5) {
  const Eigen::Matrix3d R = test::rotation(yaw_rad, 0.02, 0.0);
  return render(taught, homography(R, t_over_d_for(R, x, depth)), clutter);
}

Eigen::Matrix3d homography_of(const PoseEstimate& pose) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(pose.H_cur_from_ref.data());
}

Eigen::Vector2d seen_centre_px(const PoseEstimate& pose, const ShirtTemplate& taught) {
  const Region& roi = taught.roi;
  return (homography_of(pose) *
          Eigen::Vector3d(roi.x_px + 0.5 * roi.width_px, roi.y_px + 0.5 * roi.height_px, 1.0))
      .hnormalized();
}

TEST(PoseTracker, TracksTheBackAcrossTheViewAsWellAsASearchOfTheWholeFrame) {
  const ShirtTemplate taught = shirt();
  PoseTracker tracker(taught, robot_camera(), flat_shirt_config());
  PoseEstimator everywhere(taught, robot_camera(), flat_shirt_config());
  double tracked_error_px = 0.0, whole_error_px = 0.0;
  constexpr int kFrames = test::kSanitized ? 12 : 24;
  int frames = 0;
  for (; frames < kFrames; ++frames) {
    // The back crosses the view at 0.9 rad/s, while it turns and moves away.
    const double share = static_cast<double>(frames) / kFrames;
    const double x = -0.35 + 0.7 * share, yaw_rad = 0.6 * std::sin(6.0 * share), depth = 0.9 + 0.5 * share;
    const Eigen::Matrix3d R = test::rotation(yaw_rad, 0.02, 0.0);
    const Eigen::Matrix3d truth = homography(R, t_over_d_for(R, x, depth));
    const cv::Mat image = render(taught, truth, 40);
    const PoseEstimate pose = tracker.estimate(frame_at(image, frames));
    const PoseEstimate whole = everywhere.estimate(frame_at(image, frames));
    ASSERT_TRUE(pose.found()) << "frame " << frames;
    ASSERT_TRUE(whole.found()) << "frame " << frames;
    EXPECT_EQ(pose.tracked, frames > 0) << "frame " << frames;
    EXPECT_FALSE(whole.tracked);
    EXPECT_GE(pose.certainty, 0.9 * whole.certainty) << "frame " << frames;
    tracked_error_px += test::corner_error_px(homography_of(pose), truth);
    whole_error_px += test::corner_error_px(homography_of(whole), truth);
  }
  std::cout << "corner error tracked " << tracked_error_px / frames << " px, searching the whole frame "
            << whole_error_px / frames << " px\n";
  EXPECT_LT(tracked_error_px, 1.2 * whole_error_px);
}

// At three times the template's distance, where few of its features are as large as the smallest filter.
TEST(PoseTracker, MarksTheRegionThatItSearchedAndTheInliersInIt) {
  const ShirtTemplate taught = shirt();
  PoseTracker tracker(taught, robot_camera(), flat_shirt_config());
  const cv::Mat image = seen(taught, 0.2, 0.05, 1.1);
  for (int frame = 0; frame < 3; ++frame) {
    const PoseEstimate pose = tracker.estimate(frame_at(image, frame));
    ASSERT_TRUE(pose.found());
    const PoseMarks marks = tracker.marks();
    EXPECT_EQ(marks.frame_sequence, pose.frame_sequence);
    ASSERT_EQ(marks.has_region, frame > 0);
    ASSERT_GT(marks.inliers, 20U);
    ASSERT_LE(marks.inliers, std::min<std::size_t>(pose.inliers, PoseMarks::kMostInliers));
    const Eigen::Matrix3d H_ref_from_cur = homography_of(pose).inverse();
    for (std::uint32_t i = 0; i < marks.inliers; ++i) {
      const auto& [x_px, y_px] = marks.inlier_px[i];
      const Eigen::Vector2d ref_px =
          (H_ref_from_cur * Eigen::Vector3d(double{x_px}, double{y_px}, 1.0)).hnormalized();
      EXPECT_TRUE(ref_px.x() > taught.roi.x_px - 5 &&
                  ref_px.x() < taught.roi.x_px + taught.roi.width_px + 5 &&
                  ref_px.y() > taught.roi.y_px - 5 && ref_px.y() < taught.roi.y_px + taught.roi.height_px + 5)
          << ref_px.transpose();
    }
    if (!marks.has_region) continue;
    const Eigen::Vector2d centre_px = seen_centre_px(pose, taught);
    EXPECT_TRUE(centre_px.x() > marks.region_px[0] && centre_px.x() < marks.region_px[2]);
    EXPECT_TRUE(centre_px.y() > marks.region_px[1] && centre_px.y() < marks.region_px[3]);
  }
  const PoseEstimate lost = tracker.estimate(frame_at(cv::Mat(image.size(), CV_8U, cv::Scalar(90)), 3));
  EXPECT_FALSE(lost.found());
  EXPECT_TRUE(tracker.marks().has_region);
  EXPECT_EQ(tracker.marks().inliers, 0U);
}

TEST(PoseTracker, UpsamplesAShirtFarAway) {
  ShirtTemplate taught = shirt();
  taught.distance_m = 1.5;
  PoseTracker tracker(taught, robot_camera(), flat_shirt_config());
  PoseEstimator from_afar(taught, robot_camera(), flat_shirt_config());
  for (int number = 0; number < 5; ++number) {
    const double yaw_rad = 0.15 * (number - 2);
    const Eigen::Matrix3d R = test::rotation(yaw_rad, 0.02, 0.0);
    const Eigen::Matrix3d truth = homography(R, t_over_d_for(R, 0.1, 3.0));
    const cv::Mat image = seen(taught, yaw_rad, 0.1, 3.0);
    const FrameView frame = frame_at(image, 20 * number);
    const PoseEstimate far = from_afar.estimate(frame), searched = tracker.estimate(frame);
    ASSERT_TRUE(searched.found()) << number;
    EXPECT_FALSE(searched.tracked);
    EXPECT_GT(searched.certainty, 2.0 * far.certainty) << number;
    EXPECT_LT(test::corner_error_px(homography_of(searched), truth), 1.0) << number;
    FrameView next = frame;
    next.header.t_capture_ns += kFramePeriod_ns;
    const PoseEstimate tracked = tracker.estimate(next);
    ASSERT_TRUE(tracked.tracked) << number;
    EXPECT_GT(tracked.certainty, 2.0 * far.certainty) << number;
    EXPECT_NEAR(tracked.yaw_rad, yaw_rad, 0.05) << number;
  }
}

TEST(PoseTracker, AJumpIsFoundInTheSameFrame) {
  const ShirtTemplate taught = shirt();
  PoseTracker tracker(taught, robot_camera(), flat_shirt_config());
  EXPECT_TRUE(tracker.estimate(frame_at(seen(taught, 0.0, -0.3, 1.2), 0)).found());
  const PoseEstimate jumped = tracker.estimate(frame_at(seen(taught, 0.2, 0.35, 1.2), 1));
  ASSERT_TRUE(jumped.found());
  EXPECT_FALSE(jumped.tracked);
  EXPECT_NEAR(jumped.frame_yaw_rad, 0.2, 0.04);
  EXPECT_TRUE(tracker.estimate(frame_at(seen(taught, 0.2, 0.35, 1.2), 2)).tracked);
}

TEST(PoseTracker, SearchesTheWholeFrameWhenTheLastDetectionIsOld) {
  const ShirtTemplate taught = shirt();
  PoseTracker tracker(taught, robot_camera(), flat_shirt_config());
  const cv::Mat view = seen(taught, 0.1, 0.0, 1.2), clutter = texture(9, 640, 480);
  EXPECT_TRUE(tracker.estimate(frame_at(view, 0)).found());
  EXPECT_FALSE(tracker.estimate(frame_at(clutter, 1)).found());
  EXPECT_TRUE(tracker.estimate(frame_at(view, 2)).tracked) << "one frame without a detection";
  const PoseEstimate later = tracker.estimate(frame_at(view, 2 + 16));
  EXPECT_TRUE(later.found());
  EXPECT_FALSE(later.tracked) << "after more than half a second";
}

TEST(PoseTracker, SearchesTheWholeFrameWhenASourceStartsAgain) {
  const ShirtTemplate taught = shirt();
  PoseTracker tracker(taught, robot_camera(), flat_shirt_config());
  const cv::Mat view = seen(taught, 0.1, 0.0, 1.2);
  EXPECT_TRUE(tracker.estimate(frame_at(view, 100)).found());
  const PoseEstimate again = tracker.estimate(frame_at(view, 0));
  EXPECT_TRUE(again.found());
  EXPECT_FALSE(again.tracked);
}

TEST(PoseTracker, KeepsItsPersonWhenAnotherWearsTheSameShirt) {
  const ShirtTemplate taught = shirt();
  const cv::Mat ours = seen(taught, 0.0, -0.28, 1.6), other = seen(taught, 0.0, 0.28, 1.6);
  cv::Mat both = ours.clone();
  other(cv::Rect(320, 0, 320, 480)).copyTo(both(cv::Rect(320, 0, 320, 480)));
  for (const cv::Mat& first : {ours, other}) {
    PoseTracker tracker(taught, robot_camera(), flat_shirt_config());
    const PoseEstimate alone = tracker.estimate(frame_at(first, 0));
    ASSERT_TRUE(alone.found());
    for (int number = 1; number < 5; ++number) {
      const PoseEstimate pose = tracker.estimate(frame_at(both, number));
      ASSERT_TRUE(pose.tracked);
      EXPECT_NEAR(pose.position_m[0], alone.position_m[0], 0.05);
    }
  }
}

/// A back so small and pale that the clutter's features crowd its own out.
cv::Mat small_and_pale(const ShirtTemplate& taught, double yaw_rad) {
  const heel::BackSurface surface =
      average_back(heel::ReferenceView(taught, heel::VisionConfig{}), heel::VisionConfig{});
  const Eigen::Matrix3d R = heel::test::rotation(yaw_rad, 0.0, 0.0);
  ShirtTemplate pale = taught;
  for (std::uint8_t& grey : pale.grey) grey = static_cast<std::uint8_t>(128 + (grey - 128) / 3);
  return heel::test::render_back(pale, surface, R, t_over_d_for(R, 0.25, 2.2), 5);
}

TEST(PoseTracker, FindsInAPartWhatTheWholeFrameHides) {
  const ShirtTemplate taught = shirt();
  const heel::VisionConfig config;
  heel::VisionConfig independent = config;
  independent.tracking = false;
  PoseEstimator whole(taught, robot_camera(), config);
  PoseTracker by_itself(taught, robot_camera(), independent);
  for (const double yaw_rad : test::fewer_if_sanitized<double>({0.0, 0.6}, 1)) {
    const cv::Mat image = small_and_pale(taught, yaw_rad);
    ASSERT_FALSE(whole.estimate(frame_at(image, 0)).found())
        << "the whole frame is enough: this test tests nothing";
    const PoseEstimate found = by_itself.estimate(frame_at(image, 0));
    ASSERT_TRUE(found.found()) << yaw_rad;
    EXPECT_NEAR(found.yaw_rad, yaw_rad, 0.03);

    PoseTracker tracker(taught, robot_camera(), config);
    int number = 0;
    while (number < 2 * PoseEstimator::parts() && !tracker.estimate(frame_at(image, number)).found())
      ++number;
    EXPECT_GT(number, 0);
    EXPECT_LT(number, 2 * PoseEstimator::parts());
    EXPECT_TRUE(tracker.estimate(frame_at(image, number + 1)).tracked);
  }
}

TEST(PoseTracker, FindsANearBackInTheSecondFrameAtTheLatest) {
  const ShirtTemplate taught = shirt();
  const cv::Mat clutter = texture(9, 640, 480), view = seen(taught, 0.1, 0.0, 1.2);
  for (int empty = 0; empty < (test::kSanitized ? 2 : 4); ++empty) {
    PoseTracker tracker(taught, robot_camera(), heel::VisionConfig{});
    for (int number = 0; number < empty; ++number)
      ASSERT_FALSE(tracker.estimate(frame_at(clutter, number)).found());
    const bool at_once = tracker.estimate(frame_at(view, empty)).found();
    EXPECT_TRUE(at_once || tracker.estimate(frame_at(view, empty + 1)).found()) << empty;
  }
}

TEST(PoseTracker, WithoutTrackingItIsTheEstimator) {
  const ShirtTemplate taught = shirt();
  VisionConfig config = flat_shirt_config();
  config.tracking = false;
  PoseTracker tracker(taught, robot_camera(), config);
  PoseEstimator estimator(taught, robot_camera(), config);
  for (int number = 0; number < 3; ++number) {
    const cv::Mat view = seen(taught, 0.1 * number, 0.0, 1.0);  // near enough not to be upsampled
    const PoseEstimate tracked = tracker.estimate(frame_at(view, number));
    const PoseEstimate whole = estimator.estimate(frame_at(view, number));
    ASSERT_TRUE(whole.found());
    EXPECT_FALSE(tracked.tracked);
    EXPECT_EQ(test::pose_bytes(tracked), test::pose_bytes(whole));
  }
}

TEST(PoseTracker, ExpectedViewGrowsWithTimeAndContainsTheBack) {
  const ShirtTemplate taught = shirt();
  PoseEstimator estimator(taught, robot_camera(), flat_shirt_config());
  const PoseEstimate pose = estimator.estimate(frame_at(seen(taught, 0.3, 0.2, 1.0), 0));
  ASSERT_TRUE(pose.found());
  const ExpectedView soon = estimator.expected_view(pose, kFramePeriod_ns);
  const ExpectedView late = estimator.expected_view(pose, 10 * kFramePeriod_ns);
  EXPECT_LT(late.region.x_px, soon.region.x_px);
  EXPECT_GT(late.region.height_px, soon.region.height_px);
  EXPECT_LT(late.sigma_min_px, soon.sigma_min_px);
  EXPECT_GT(late.sigma_max_px, soon.sigma_max_px);
  const Eigen::Vector2d centre = robot_camera().distort_px(
      (homography_of(pose) * taught.camera.undistort_px({319.5, 239.5}).homogeneous()).hnormalized());
  EXPECT_NEAR(soon.region.x_px + 0.5 * soon.region.width_px, centre.x(), 0.15 * soon.region.width_px);
  EXPECT_NEAR(soon.region.y_px + 0.5 * soon.region.height_px, centre.y(), 0.15 * soon.region.height_px);
}

TEST(PoseTracker, AllocatesNothingAfterConstruction) {
  if (!test::counts_allocations()) GTEST_SKIP() << "a sanitizer owns the allocator";
  const ShirtTemplate taught = shirt();
  PoseTracker tracker(taught, robot_camera(), VisionConfig{});
  const cv::Mat view = seen(taught, 0.3, 0.0, 1.2), clutter = texture(9, 640, 480);
  const std::uint64_t before = test::allocations_of_this_thread();
  tracker.estimate(frame_at(view, 0));
  const bool tracked = tracker.estimate(frame_at(view, 1)).tracked;
  tracker.estimate(frame_at(clutter, 2));
  EXPECT_EQ(test::allocations_of_this_thread() - before, 0u);
  EXPECT_TRUE(tracked);
}

}  // namespace
}  // namespace heel
