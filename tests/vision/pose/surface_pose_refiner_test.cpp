// Patches of a rendered back bring a pose that is several degrees off to its true one, and tell a pose that
// is right from one that is wrong.
#include "vision/pose/surface_pose_refiner.h"

#include <gtest/gtest.h>

#include <iostream>

#include "support/allocation_count.h"
#include "vision/pose/average_back.h"
#include "vision/pose/rendered_back.h"

namespace heel {
namespace {

using test::robot_camera;

struct RenderedBack {
  explicit RenderedBack(double yaw_rad, double depth = 1.0)
      : shirt(test::shirt()), surface(average_back(ReferenceView(shirt, VisionConfig{}), VisionConfig{})) {
    truth.R_cur_from_ref = test::rotation(yaw_rad, 0.03, 0.0);
    truth.t_over_d = test::t_over_d_for(truth.R_cur_from_ref, 0.05, depth);
    image = test::render_back(shirt, surface, truth.R_cur_from_ref, truth.t_over_d, 5);
  }
  /// The truth turned about the middle of the back.
  FrontalMotion turned(double turn_rad) const {
    const Eigen::Vector3d middle(surface.axis_x, surface.axis_y, 1.0);
    FrontalMotion motion;
    motion.R_cur_from_ref = test::rotation(turn_rad, 0.0, 0.0) * truth.R_cur_from_ref;
    motion.t_over_d = truth.t_over_d + (truth.R_cur_from_ref - motion.R_cur_from_ref) * middle;
    return motion;
  }

  ShirtTemplate shirt;
  BackSurface surface;
  FrontalMotion truth;
  cv::Mat image;
};

TEST(SurfacePoseRefiner, BringsAPoseThatIsOffToTheTrueOne) {
  for (const double yaw_rad : {-0.6, -0.2, 0.0, 0.5}) {
    const RenderedBack back(yaw_rad);
    SurfacePoseRefiner refiner(back.shirt, robot_camera());
    for (const double turn_rad : {-0.07, 0.0, 0.07}) {
      const std::optional<SurfacePose> pose =
          refiner.refine(test::view_of(back.image), back.surface, {}, back.turned(turn_rad), 3);
      ASSERT_TRUE(pose) << yaw_rad;
      EXPECT_NEAR(yaw_of_rotation(pose->motion.R_cur_from_ref), yaw_rad, 0.01) << "start " << turn_rad;
      EXPECT_LT((pose->motion.t_over_d - back.truth.t_over_d).norm(), 0.02);
      EXPECT_GT(pose->agreement, 0.8) << yaw_rad;
      EXPECT_GT(pose->score, 0.75 * static_cast<double>(pose->patches));
    }
  }
}

// The mirror image of the pose in the line of sight, the second minimum of a plane, is not one of a back.
TEST(SurfacePoseRefiner, FindsTheTruePoseFromItsMirrorImage) {
  const RenderedBack back(0.35);
  SurfacePoseRefiner refiner(back.shirt, robot_camera());
  const FrameView frame = test::view_of(back.image);
  const std::optional<SurfacePose> pose = refiner.refine(frame, back.surface, {}, back.turned(-0.7), 3);
  ASSERT_TRUE(pose);
  EXPECT_NEAR(yaw_of_rotation(pose->motion.R_cur_from_ref), 0.35, 0.01);
}

TEST(SurfacePoseRefiner, APoseInTheWrongPlaceHasASmallScore) {
  const RenderedBack back(0.2);
  SurfacePoseRefiner refiner(back.shirt, robot_camera());
  const FrameView frame = test::view_of(back.image);
  const std::optional<SurfacePose> right = refiner.refine(frame, back.surface, {}, back.truth, 3);
  ASSERT_TRUE(right);
  FrontalMotion beside = back.truth;
  beside.t_over_d.x() += 0.05;  // 26 px
  const std::optional<SurfacePose> wrong = refiner.refine(frame, back.surface, {}, beside, 3);
  EXPECT_LT(wrong ? wrong->score : 0.0, 0.2 * right->score);
  EXPECT_LT(wrong ? wrong->agreement : 0.0, 0.2);
}

TEST(SurfacePoseRefiner, FindsTooLittleInClutter) {
  const RenderedBack back(0.0);
  SurfacePoseRefiner refiner(back.shirt, robot_camera());
  const cv::Mat clutter = test::texture(9, 640, 480);
  const std::optional<SurfacePose> pose =
      refiner.refine(test::view_of(clutter), back.surface, {}, back.truth, 3);
  EXPECT_LT(pose ? pose->agreement : 0.0, 0.1);
}

TEST(SurfacePoseRefiner, AllocatesNothing) {
  if (!test::counts_allocations()) GTEST_SKIP() << "a sanitizer owns the allocator";
  const RenderedBack back(0.2);
  SurfacePoseRefiner refiner(back.shirt, robot_camera());
  const FrameView frame = test::view_of(back.image);
  const std::uint64_t before = test::allocations_of_this_thread();
  const std::optional<SurfacePose> pose = refiner.refine(frame, back.surface, {}, back.truth, 3);
  EXPECT_EQ(test::allocations_of_this_thread() - before, 0u);
  EXPECT_TRUE(pose);
}

}  // namespace
}  // namespace heel
