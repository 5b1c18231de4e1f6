// Whom it follows: the shirt at two places of a frame is refused in a search, and never exchanged while
// tracking.
#include "vision/pose/second_place_search.h"

#include <gtest/gtest.h>

#include <functional>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "heel/pose_tracker.h"
#include "support/allocation_count.h"
#include "support/sanitized.h"
#include "vision/pose/average_back.h"
#include "vision/pose/frame_sequence.h"
#include "vision/pose/rendered_back.h"

namespace heel {
namespace {

using test::fewer_if_sanitized;
using test::frame_at;
using test::robot_camera;
using test::shirt;
using test::side_by_side;
using test::t_over_d_for;

constexpr double kOurs_x = -0.3, kOther_x = 0.28;

cv::Mat back(const ShirtTemplate& print, double yaw_rad, double x, double depth) {
  const BackSurface surface = average_back(ReferenceView(shirt(), VisionConfig{}), VisionConfig{});
  const Eigen::Matrix3d R = test::rotation(yaw_rad, 0.0, 0.0);
  return test::render_back(print, surface, R, t_over_d_for(R, x, depth), 5);
}

cv::Mat board(const ShirtTemplate& print, double yaw_rad, double x, double depth) {
  const Eigen::Matrix3d R = test::rotation(yaw_rad, 0.0, 0.0);
  return test::render(print, test::homography(R, t_over_d_for(R, x, depth)), 5);
}

/// The shirt with another print on its region.
ShirtTemplate with_print(const std::function<void(cv::Mat&)>& change) {
  ShirtTemplate print = shirt();
  cv::Mat image(print.camera.height_px, print.camera.width_px, CV_8U, print.grey.data());
  cv::Mat region = image(cv::Rect(print.roi.x_px, print.roi.y_px, print.roi.width_px, print.roi.height_px));
  change(region);
  return print;
}

void mirror(cv::Mat& region) {
  const cv::Mat original = region.clone();
  cv::flip(original, region, 1);
}

void mirror_and_dim(cv::Mat& region) {
  mirror(region);
  region.convertTo(region, -1, 0.5, 20.0);
}

/// Every second field of a chessboard is printed the other way round.
void invert_in_parts(cv::Mat& region) {
  constexpr int kField_px = 40;
  for (int y = 0; y < region.rows; ++y)
    for (int x = 0; x < region.cols; ++x)
      if ((x / kField_px + y / kField_px) % 2 == 0)
        region.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(255 - region.at<std::uint8_t>(y, x));
}

void halve_contrast(cv::Mat& region) {
  region.convertTo(region, -1, 0.5, 40.0);
}

/// Of pictures three times as wide and high.
CameraModel enlarged(CameraModel camera) {
  constexpr int kTimes = 3;
  const auto place_px = [](double px) { return kTimes * (px + 0.5) - 0.5; };
  camera.width_px *= kTimes;
  camera.height_px *= kTimes;
  camera.fx *= kTimes;
  camera.fy *= kTimes;
  camera.cx = place_px(camera.cx);
  camera.cy = place_px(camera.cy);
  return camera;
}

cv::Mat enlarged(const cv::Mat& frame, const CameraModel& camera) {
  cv::Mat large;
  cv::resize(frame, large, {camera.width_px, camera.height_px}, 0.0, 0.0, cv::INTER_CUBIC);
  return large;
}

bool on_the_left(const PoseEstimate& pose) {
  return pose.position_m[0] < 0.0;
}

struct Other {
  const char* name;
  cv::Mat frame;  ///< with it alone, in the right half
};

/// Each can be followed when it is there alone: nothing in the picture says that it is not the person.
std::vector<Other> others_that_match() {
  const ShirtTemplate taught = shirt();
  return {{"the same shirt", back(taught, 0.0, kOther_x, 1.6)},
          {"the same shirt, turned", back(taught, 0.7, kOther_x, 1.6)},
          {"a poster of it", board(taught, -0.2, kOther_x, 1.6)},
          {"a chair with the shirt", back(taught, -0.3, kOther_x, 2.2)},
          {"the shirt in paler colours", back(with_print(halve_contrast), 0.0, kOther_x, 1.6)}};
}

std::vector<Other> others_that_do_not_match() {
  return {{"its mirror image", back(with_print(mirror), 0.0, kOther_x, 1.6)},
          {"its mirror image, turned", back(with_print(mirror), 0.6, kOther_x, 1.6)},
          {"its reflection", back(with_print(mirror_and_dim), 0.2, kOther_x, 1.7)},
          {"the design in other colours", back(with_print(invert_in_parts), 0.0, kOther_x, 1.6)}};
}

TEST(SecondPlaceSearch, ASearchThatFindsTwoRefuses) {
  const ShirtTemplate taught = shirt();
  const cv::Mat ours = back(taught, 0.2, kOurs_x, 1.6);
  for (const Other& other : fewer_if_sanitized(others_that_match(), 1)) {
    PoseTracker tracker(taught, robot_camera(), VisionConfig{});
    EXPECT_TRUE(tracker.estimate(frame_at(other.frame, 0)).found()) << other.name << ", alone";
    // A second later, so that nothing is expected any more.
    int ambiguous = 0;
    for (int number = 30; number < 34; ++number) {
      const PoseEstimate pose = tracker.estimate(frame_at(side_by_side(ours, other.frame), number));
      EXPECT_FALSE(pose.found()) << other.name;
      ambiguous += pose.reason == PoseReason::Ambiguous;
    }
    EXPECT_GT(ambiguous, 0) << other.name;
    const PoseEstimate alone = tracker.estimate(frame_at(ours, 34));
    EXPECT_TRUE(alone.found() && on_the_left(alone)) << other.name << ": ours alone again";
  }
}

/// Backs so large that no closer look enlarges them.
TEST(SecondPlaceSearch, ASearchOfALargeFrameThatFindsTwoRefuses) {
  const ShirtTemplate taught = shirt();
  const CameraModel camera = enlarged(robot_camera());
  const cv::Mat ours = back(taught, 0.2, kOurs_x, 1.6);
  for (const Other& other : fewer_if_sanitized(others_that_match(), 1)) {
    PoseTracker tracker(taught, camera, VisionConfig{});
    const cv::Mat both = enlarged(side_by_side(ours, other.frame), camera);
    const PoseEstimate pose = tracker.estimate(frame_at(both, 0));
    EXPECT_EQ(pose.reason, PoseReason::Ambiguous) << other.name;
    const PoseEstimate alone = tracker.estimate(frame_at(enlarged(ours, camera), 30));
    EXPECT_TRUE(alone.found() && on_the_left(alone)) << other.name;
  }
}

TEST(SecondPlaceSearch, WhatDoesNotMatchIsNoSecondPlace) {
  const ShirtTemplate taught = shirt();
  const cv::Mat ours = back(taught, 0.2, kOurs_x, 1.6);
  for (const Other& other : fewer_if_sanitized(others_that_do_not_match(), 2)) {
    PoseTracker tracker(taught, robot_camera(), VisionConfig{});
    const PoseEstimate alone = tracker.estimate(frame_at(other.frame, 0));
    EXPECT_FALSE(alone.found()) << other.name << ", certainty " << alone.certainty;
    const PoseEstimate pose = tracker.estimate(frame_at(side_by_side(ours, other.frame), 30));
    EXPECT_TRUE(pose.found() && on_the_left(pose)) << other.name << ": " << to_string(pose.reason);
  }
}

TEST(SecondPlaceSearch, TrackingKeepsOursBesideAnything) {
  if (test::kSanitized) GTEST_SKIP() << "AnotherDoesNotTakeThePlaceOfOneWhoIsHidden runs the same code";
  constexpr int kHidden = 3;  // for one frame nobody is seen
  const ShirtTemplate taught = shirt();
  std::vector<cv::Mat> ours;  // who walks and turns
  for (int number = 0; number < 6; ++number)
    ours.push_back(back(taught, 0.05 * number, kOurs_x + 0.01 * number, 1.6));
  std::vector<Other> others = others_that_match();
  for (const Other& other : others_that_do_not_match()) others.push_back(other);
  const cv::Mat nobody = test::texture(9, 640, 480);
  for (const Other& other : others) {
    PoseTracker tracker(taught, robot_camera(), VisionConfig{});
    ASSERT_TRUE(tracker.estimate(frame_at(ours[0], 0)).found());
    for (int number = 1; number < static_cast<int>(ours.size()); ++number) {
      const cv::Mat both = side_by_side(ours[static_cast<std::size_t>(number)], other.frame);
      const PoseEstimate pose = tracker.estimate(frame_at(number == kHidden ? nobody : both, number));
      EXPECT_EQ(pose.found(), number != kHidden)
          << other.name << ", frame " << number << ": " << to_string(pose.reason);
      EXPECT_TRUE(!pose.found() || on_the_left(pose)) << other.name << ", frame " << number;
    }
  }
}

TEST(SecondPlaceSearch, AnotherDoesNotTakeThePlaceOfOneWhoIsHidden) {
  const ShirtTemplate taught = shirt();
  const cv::Mat ours = back(taught, 0.2, kOurs_x, 1.6), other = back(taught, 0.0, kOther_x, 1.6);
  PoseTracker tracker(taught, robot_camera(), VisionConfig{});
  int number = 0;
  for (; number < 5; ++number) ASSERT_TRUE(tracker.estimate(frame_at(ours, number)).found());
  for (; number < 8; ++number)
    EXPECT_EQ(tracker.estimate(frame_at(other, number)).reason, PoseReason::OutOfReach) << number;
  const PoseEstimate again = tracker.estimate(frame_at(side_by_side(ours, other), number));
  EXPECT_TRUE(again.found() && on_the_left(again)) << to_string(again.reason);
  for (; number < 12; ++number) tracker.estimate(frame_at(other, number));
  EXPECT_TRUE(tracker.estimate(frame_at(other, number + 15)).found()) << "ours is lost, and one is there";
}

TEST(SecondPlaceSearch, ABoardAloneIsFound) {
  const ShirtTemplate taught = shirt();
  PoseTracker tracker(taught, robot_camera(), VisionConfig{});
  const PoseEstimate pose = tracker.estimate(frame_at(board(taught, 0.3, kOther_x, 1.6), 0));
  ASSERT_TRUE(pose.found()) << to_string(pose.reason);
  EXPECT_FALSE(on_the_left(pose));
}

TEST(SecondPlaceSearch, AllocatesNothing) {
  if (!test::counts_allocations()) GTEST_SKIP() << "a sanitizer owns the allocator";
  const ShirtTemplate taught = shirt();
  PoseTracker tracker(taught, robot_camera(), VisionConfig{});
  const cv::Mat both = side_by_side(back(taught, 0.2, kOurs_x, 1.6), back(taught, 0.8, kOther_x, 1.6));
  const std::uint64_t before = test::allocations_of_this_thread();
  const bool found = tracker.estimate(frame_at(both, 0)).found();
  EXPECT_EQ(test::allocations_of_this_thread() - before, 0u);
  EXPECT_FALSE(found);
}

}  // namespace
}  // namespace heel
