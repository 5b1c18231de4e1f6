// A back at another yaw that explains the frame nearly as well: it is chosen where its patches agree better,
// and where they agree as well the stated deviation says so.
#include "vision/pose/other_minimum.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "heel/motion.h"
#include "heel/pose_tracker.h"
#include "support/allocation_count.h"
#include "vision/pose/average_back.h"
#include "vision/pose/frame_sequence.h"
#include "vision/pose/rendered_back.h"

namespace heel {
namespace {

using test::robot_camera;

/// Twice as far away as it was taught.
struct DistantBack {
  explicit DistantBack(double yaw_rad)
      : shirt(test::shirt()),
        reference(shirt, VisionConfig{}),
        surface(average_back(reference, VisionConfig{})),
        refiner(shirt, robot_camera()) {
    truth.R_cur_from_ref = test::rotation(yaw_rad, 0.0, 0.0);
    truth.t_over_d = test::t_over_d_for(truth.R_cur_from_ref, 0.0, 2.0);
    image = test::render_back(shirt, surface, truth.R_cur_from_ref, truth.t_over_d, 5);
  }
  FrontalProblem geometry() const {
    return {{}, reference.K, robot_camera().K(), {}, reference.centre_px, surface};
  }
  FrontalPose better(const SurfacePose& pose) {
    return better_minimum(refiner, test::view_of(image), geometry(), pose);
  }

  ShirtTemplate shirt;
  ReferenceView reference;
  BackSurface surface;
  SurfacePoseRefiner refiner;
  FrontalMotion truth;
  cv::Mat image;
};

TEST(OtherMinimum, APoseThatIsRightStaysAsItIs) {
  for (const double yaw_rad : {-0.5, 0.0, 0.3}) {
    DistantBack back(yaw_rad);
    const std::optional<SurfacePose> pose =
        back.refiner.refine(test::view_of(back.image), back.surface, {}, back.truth, 3);
    ASSERT_TRUE(pose);
    const FrontalPose better = back.better(*pose);
    EXPECT_EQ(better.yaw_rad, frontal_pose(*pose).yaw_rad);
    EXPECT_NEAR(better.yaw_sigma_rad, frontal_pose(*pose).yaw_sigma_rad, 0.005);
    EXPECT_LT(better.ambiguity, 0.01);
  }
}

TEST(OtherMinimum, APoseOnTheWrongSideIsReplaced) {
  for (const double yaw_rad : {-0.4, 0.25, 0.4}) {
    DistantBack back(yaw_rad);
    const PlaneMotion mirrored = mirrored_motion(back.geometry(), back.truth);
    SurfacePose wrong;
    wrong.motion.R_cur_from_ref = mirrored.R_cur_from_ref;
    wrong.motion.t_over_d = mirrored.t_over_d;
    wrong.score = 40.0;  // of 150 patches
    const FrontalPose better = back.better(wrong);
    EXPECT_NEAR(better.yaw_rad, yaw_rad, 0.02);
    EXPECT_LT(better.ambiguity, 0.01);
    EXPECT_NEAR(yaw_of_rotation(better.other.R_cur_from_ref), -yaw_rad, 0.1);
  }
}

TEST(OtherMinimum, TheDeviationSaysHowNearlyAsGoodTheOtherOneIs) {
  SurfacePose chosen, rejected;
  chosen.motion.R_cur_from_ref = test::rotation(0.3, 0.0, 0.0);
  rejected.motion.R_cur_from_ref = test::rotation(-0.3, 0.0, 0.0);
  chosen.covariance = 1e-4 * Matrix6d::Identity();
  chosen.score = rejected.score = 100.0;
  const FrontalPose even = weighed(chosen, rejected);
  EXPECT_EQ(even.yaw_rad, frontal_pose(chosen).yaw_rad);
  EXPECT_NEAR(even.ambiguity, 0.5, 1e-12);
  const double own_sigma_rad = frontal_pose(chosen).yaw_sigma_rad;
  EXPECT_NEAR(even.yaw_sigma_rad, std::hypot(own_sigma_rad, 0.6 * std::sqrt(0.5)), 1e-9);
  double last_rad = even.yaw_sigma_rad;
  for (const double score : {98.0, 95.0, 90.0}) {
    rejected.score = score;
    const double sigma_rad = weighed(chosen, rejected).yaw_sigma_rad;
    EXPECT_LT(sigma_rad, last_rad);
    last_rad = sigma_rad;
  }
  EXPECT_NEAR(last_rad, own_sigma_rad, 0.02);
}

/// Relief the other way round hides which side is nearer: the back looks turned to either side.
cv::Mat ambiguous_back(double yaw_rad) {
  const DistantBack back(yaw_rad);
  BackSurface shown = back.surface;
  for (double* depth :
       {&shown.depth.u2, &shown.depth.u4, &shown.depth.v, &shown.depth.v2, &shown.depth.v3, &shown.depth.u2v})
    *depth *= -0.5;
  const Eigen::Matrix3d R = test::rotation(yaw_rad, 0.0, 0.0);
  return test::render_back(back.shirt, shown, R, test::t_over_d_for(R, 0.0, 3.2), 5);
}

TEST(OtherMinimum, TrackingStaysUnsureForAsLongAsThePictureDoes) {
  PoseTracker tracker(test::shirt(), robot_camera(), VisionConfig{});
  for (int number = 0; number < 3; ++number) {
    const PoseEstimate pose = tracker.estimate(test::frame_at(ambiguous_back(0.2 + 0.01 * number), number));
    ASSERT_TRUE(pose.found());
    EXPECT_EQ(pose.tracked, number > 0);
    EXPECT_GT(pose.frame_yaw_sigma_rad, 0.2) << number;
  }
}

TEST(OtherMinimum, AllocatesNothing) {
  if (!test::counts_allocations()) GTEST_SKIP() << "a sanitizer owns the allocator";
  DistantBack back(0.3);
  const FrameView frame = test::view_of(back.image);
  const std::optional<SurfacePose> pose = back.refiner.refine(frame, back.surface, {}, back.truth, 3);
  ASSERT_TRUE(pose);
  const FrontalProblem geometry = back.geometry();
  const std::uint64_t before = test::allocations_of_this_thread();
  better_minimum(back.refiner, frame, geometry, *pose);
  EXPECT_EQ(test::allocations_of_this_thread() - before, 0u);
}

}  // namespace
}  // namespace heel
