// Every gate of vision refuses under its own name, and each of them can be the one that refuses.
#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>
#include <set>
#include <string>

#include "heel/pose_estimator.h"
#include "support/sanitized.h"
#include "vision/pose/average_back.h"
#include "vision/pose/rendered_back.h"

namespace heel {
namespace {

constexpr int kReasons = static_cast<int>(PoseReason::Ambiguous) + 1;

cv::Mat picture(const ShirtTemplate& shirt, double yaw_rad, double x, double depth) {
  const BackSurface surface = average_back(ReferenceView(test::shirt(), VisionConfig{}), VisionConfig{});
  const Eigen::Matrix3d R = test::rotation(yaw_rad, 0.0, 0.0);
  return test::render_back(shirt, surface, R, test::t_over_d_for(R, x, depth), 5);
}

TEST(Refusals, EveryReasonHasANameOfItsOwn) {
  std::set<std::string> names;
  for (int i = 0; i < kReasons; ++i) names.insert(to_string(static_cast<PoseReason>(i)));
  EXPECT_EQ(names.size(), static_cast<std::size_t>(kReasons));
  EXPECT_FALSE(names.contains("?"));
}

// NoValidMotion is not among them: the check of the outline refuses mirrored and folded views before.
// Ambiguous and OutOfReach: second_place_search_test.cpp.
TEST(Refusals, APictureForEachGate) {
  const ShirtTemplate taught = test::shirt();
  const auto reason = [&](const cv::Mat& image, const VisionConfig& config = {}) {
    return PoseEstimator(taught, test::robot_camera(), config).estimate(test::view_of(image)).reason;
  };
  const cv::Mat back = picture(taught, 0.0, 0.0, 1.3);
  ASSERT_EQ(reason(back), PoseReason::Found);
  EXPECT_EQ(reason(cv::Mat::zeros(480, 640, CV_8U)), PoseReason::TooFewFeatures);
  EXPECT_EQ(reason(test::texture(3, 320, 240)), PoseReason::WrongFrameSize);
  cv::Mat dots(480, 640, CV_8U, cv::Scalar(200));
  for (int i = 0; i < 5; ++i) cv::circle(dots, {100 + 100 * i, 200 + 15 * i}, 6, 20, -1, cv::LINE_AA);
  EXPECT_EQ(reason(dots), PoseReason::TooFewMatches);
  VisionConfig near_only;
  near_only.distance_min_m = 0.6;
  near_only.distance_max_m = 0.8;
  EXPECT_EQ(reason(back, near_only), PoseReason::ImplausibleShape);
  VisionConfig demanding;
  demanding.min_certainty = 0.99;
  EXPECT_EQ(reason(back, demanding), PoseReason::TooFewInliers);
}

TEST(Refusals, ClutterIsRefusedByHomographyAndPatches) {
  if (test::kSanitized) GTEST_SKIP() << "PoseEstimator.ClutterIsNeverTheShirt runs the same code";
  PoseEstimator estimator(test::shirt(), test::robot_camera(), VisionConfig{});
  std::set<PoseReason> seen;
  for (std::uint64_t seed = 1000; seed < 1060; ++seed)
    seen.insert(estimator.estimate(test::view_of(test::texture(seed, 640, 480))).reason);
  EXPECT_TRUE(seen.contains(PoseReason::NoHomography));
  EXPECT_TRUE(seen.contains(PoseReason::PatchesDisagree));
  EXPECT_FALSE(seen.contains(PoseReason::Found));
}

}  // namespace
}  // namespace heel
