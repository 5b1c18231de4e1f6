// Several templates of one person: which of them is used follows evidence, and every pose is in the terms of
// the back.
#include "vision/pose/template_selector.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "heel/error.h"
#include "support/allocation_count.h"
#include "support/pose_bytes.h"
#include "vision/pose/frame_sequence.h"
#include "vision/pose/rendered_shirt.h"

namespace heel {
namespace {

using test::flat_shirt_config;
using test::frame_at;
using test::robot_camera;
using test::side_by_side;
using test::t_over_d_for;

constexpr double kSide_rad = M_PI_2;

/// Of a person who walked to the image's right when the picture was taken.
ShirtTemplate side() {
  ShirtTemplate shirt = test::shirt();
  const cv::Mat image = test::texture(77, 640, 480);
  shirt.grey.assign(image.data, image.data + image.total());
  shirt.yaw_rad = kSide_rad;
  return shirt;
}

std::vector<ShirtTemplate> back_and_side() {
  return {test::shirt(), side()};
}

/// What `shirt` shows, turned by `yaw_rad` from its reference view, `x` template distances to the right.
cv::Mat seen(const ShirtTemplate& shirt, double yaw_rad, double x) {
  const Eigen::Matrix3d R = test::rotation(yaw_rad, 0.0, 0.0);
  return test::render(shirt, test::homography(R, t_over_d_for(R, x, 1.3)), 5);
}

TEST(TemplateSelector, WithOneTemplateItIsTheTrackerToTheBit) {
  const std::vector<ShirtTemplate> one{test::shirt()};
  TemplateSelector selector(one, robot_camera(), flat_shirt_config());
  PoseTracker tracker(one.front(), robot_camera(), flat_shirt_config());
  const cv::Mat clutter = test::texture(9, 640, 480);
  for (int number = 0; number < 6; ++number) {
    const cv::Mat image = number == 3 ? clutter : seen(one.front(), 0.1 * number, 0.02 * number);
    EXPECT_EQ(test::pose_bytes(selector.estimate(frame_at(image, number))),
              test::pose_bytes(tracker.estimate(frame_at(image, number))))
        << number;
  }
}

TEST(TemplateSelector, AnotherTemplateTakesOverWhereThePersonIs) {
  const std::vector<ShirtTemplate> templates = back_and_side();
  TemplateSelector selector(templates, robot_camera(), flat_shirt_config());
  const PoseEstimate back = selector.estimate(frame_at(seen(templates[0], 0.3, -0.2), 0));
  ASSERT_TRUE(back.found());
  EXPECT_EQ(back.template_index, 0u);
  const PoseEstimate turned = selector.estimate(frame_at(seen(templates[1], -0.2, -0.2), 1));
  ASSERT_TRUE(turned.found()) << to_string(turned.reason);
  EXPECT_EQ(turned.template_index, 1u);
  EXPECT_NEAR(turned.yaw_rad, kSide_rad - 0.2, 0.04);
  EXPECT_GT(turned.yaw_sigma_rad, 0.05) << "how far the person was turned is known to some degrees";
  EXPECT_NEAR(turned.position_m[0], back.position_m[0], 0.25);
  EXPECT_NEAR(turned.position_m[2], back.position_m[2], 0.25);
}

TEST(TemplateSelector, TheCurrentTemplateIsKeptWhileItIsFound) {
  const std::vector<ShirtTemplate> templates = back_and_side();
  TemplateSelector selector(templates, robot_camera(), flat_shirt_config());
  const cv::Mat back = seen(templates[0], 0.0, -0.3), of_side = seen(templates[1], 0.0, 0.3),
                both = side_by_side(back, of_side);
  ASSERT_TRUE(selector.estimate(frame_at(back, 0)).found());
  for (int number = 1; number < 4; ++number)
    EXPECT_EQ(selector.estimate(frame_at(both, number)).template_index, 0u);
  // Half a minute later the other one takes over, and is kept in its turn.
  selector.estimate(frame_at(of_side, 1000));
  ASSERT_TRUE(selector.estimate(frame_at(of_side, 1001)).found());
  for (int number = 1002; number < 1005; ++number) {
    const PoseEstimate pose = selector.estimate(frame_at(both, number));
    EXPECT_TRUE(pose.found());
    EXPECT_EQ(pose.template_index, 1u);
  }
}

TEST(TemplateSelector, NotAtAnotherPlace) {
  const std::vector<ShirtTemplate> templates = back_and_side();
  TemplateSelector selector(templates, robot_camera(), flat_shirt_config());
  ASSERT_TRUE(selector.estimate(frame_at(seen(templates[0], 0.0, -0.3), 0)).found());
  const cv::Mat elsewhere = seen(templates[1], 0.0, 0.3);
  for (int number = 1; number < 8; ++number)
    EXPECT_FALSE(selector.estimate(frame_at(elsewhere, number)).found()) << number;
}

TEST(TemplateSelector, WithoutATrackItIsFoundTwice) {
  const std::vector<ShirtTemplate> templates = back_and_side();
  TemplateSelector selector(templates, robot_camera(), flat_shirt_config());
  const cv::Mat of_side = seen(templates[1], 0.2, 0.1), clutter = test::texture(9, 640, 480);
  EXPECT_FALSE(selector.estimate(frame_at(of_side, 0)).found());
  EXPECT_FALSE(selector.estimate(frame_at(clutter, 1)).found());
  EXPECT_FALSE(selector.estimate(frame_at(of_side, 2)).found()) << "not in a row";
  const PoseEstimate pose = selector.estimate(frame_at(of_side, 3));
  ASSERT_TRUE(pose.found());
  EXPECT_EQ(pose.template_index, 1u);
  EXPECT_NEAR(pose.yaw_rad, kSide_rad + 0.2, 0.04);
}

TEST(TemplateSelector, ThreeAreSearchedInTurn) {
  std::vector<ShirtTemplate> templates = back_and_side();
  templates.push_back(templates[1]);
  const cv::Mat front = test::texture(78, 640, 480);
  templates[2].grey.assign(front.data, front.data + front.total());
  templates[2].yaw_rad = M_PI;
  TemplateSelector selector(templates, robot_camera(), flat_shirt_config());
  const cv::Mat image = seen(templates[2], 0.1, 0.0);
  int frames = 0;
  PoseEstimate pose;
  while (!pose.found() && frames < 10) pose = selector.estimate(frame_at(image, frames++));
  EXPECT_EQ(frames, 3) << "one other in a frame: the side, the front, the front again";
  EXPECT_EQ(pose.template_index, 2u);
  EXPECT_NEAR(std::remainder(pose.yaw_rad - M_PI - 0.1, 2.0 * M_PI), 0.0, 0.04);
}

TEST(TemplateSelector, WithoutTrackingEveryFrameIsByItself) {
  const std::vector<ShirtTemplate> templates = back_and_side();
  VisionConfig config = flat_shirt_config();
  config.tracking = false;
  TemplateSelector selector(templates, robot_camera(), config);
  for (const std::uint32_t index : {1u, 0u, 1u}) {
    const PoseEstimate pose =
        selector.estimate(frame_at(seen(templates[index], 0.1, index == 0 ? 0.2 : -0.2), 0));
    EXPECT_TRUE(pose.found()) << index;
    EXPECT_EQ(pose.template_index, index);
  }
}

TEST(TemplateSelector, SeveralNeedDistances) {
  std::vector<ShirtTemplate> templates = back_and_side();
  templates[1].distance_m = 0.0;
  EXPECT_THROW(TemplateSelector(templates, robot_camera(), flat_shirt_config()), Error);
}

TEST(TemplateSelector, AllocatesNothing) {
  if (!test::counts_allocations()) GTEST_SKIP() << "a sanitizer owns the allocator";
  const std::vector<ShirtTemplate> templates = back_and_side();
  TemplateSelector selector(templates, robot_camera(), flat_shirt_config());
  const cv::Mat back = seen(templates[0], 0.3, 0.0), of_side = seen(templates[1], 0.0, 0.0);
  const std::uint64_t before = test::allocations_of_this_thread();
  selector.estimate(frame_at(back, 0));
  const bool found = selector.estimate(frame_at(of_side, 1)).found();
  EXPECT_EQ(test::allocations_of_this_thread() - before, 0u);
  EXPECT_TRUE(found);
}

}  // namespace
}  // namespace heel
