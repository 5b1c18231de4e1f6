// The pose of a plane of known normal: accuracy, flips, and whether the stated sigma is correct.
#include "vision/pose/frontal_pose_estimator.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "support/allocation_count.h"
#include "vision/pose/scene.h"

namespace heel {
namespace {

using test::inlier_pairs;
using test::plain_camera;
using test::Random;
using test::random_view;
using test::View;

struct Outcome {
  FrontalPose pose;
  double bare_yaw_rad;  // of the decomposition alone
};

Outcome solve(const std::vector<PointPair>& pairs, bool& ok) {
  const Eigen::Matrix3d K = plain_camera().K();
  Outcome outcome{};
  Eigen::Matrix3d H;
  ok = homography_dlt(pairs, H) == HomographyStatus::Ok;
  if (!ok) return outcome;
  std::vector<Eigen::Vector2d> ref;
  for (const PointPair& pair : pairs) ref.push_back((K.inverse() * pair.ref_px.homogeneous()).hnormalized());
  const PlaneMotions motions = decompose_plane_motion(K.inverse() * H * K);
  const MotionChoice choice = choose_motion(motions, ref);
  ok = choice.best >= 0;
  if (!ok) return outcome;
  const PlaneMotion& start = motions.motions[static_cast<std::size_t>(choice.best)];
  outcome.bare_yaw_rad = yaw_of_rotation(start.R_cur_from_ref);
  outcome.pose = FrontalPoseEstimator(pairs.size()).estimate({pairs, K, K, H, {320.0, 240.0}}, start);
  return outcome;
}

TEST(FrontalPose, ExactWithoutNoise) {
  for (std::uint64_t seed = 1; seed <= 500; ++seed) {
    Random random(seed);
    const View view = random_view(random, plain_camera(), 1.1);
    bool ok = false;
    const Outcome outcome = solve(inlier_pairs(random, view.H, 30, 0.0, 0.0), ok);
    ASSERT_TRUE(ok) << "seed " << seed;
    EXPECT_LT((outcome.pose.motion.R_cur_from_ref - view.R).norm(), 1e-5) << "seed " << seed;
    EXPECT_LT((outcome.pose.motion.t_over_d - view.t_over_d).norm(), 1e-5) << "seed " << seed;
  }
}

TEST(FrontalPose, ReferenceViewItselfGivesNoMotion) {
  Random random(3);
  bool ok = false;
  const Outcome outcome = solve(inlier_pairs(random, Eigen::Matrix3d::Identity(), 50, 0.0, 0.0), ok);
  ASSERT_TRUE(ok);
  EXPECT_NEAR(outcome.pose.yaw_rad, 0.0, 1e-6);
  EXPECT_LT(outcome.pose.motion.t_over_d.norm(), 1e-6);
}

// The mean squared normalised error over n trials is χ²/n, within its 95 % band, which the noise estimate
// from few residuals widens. The views are large enough in the image, or turned enough, that no flip occurs.
TEST(FrontalPose, StatedSigmaIsThatOfTheErrors) {
  constexpr int kTrials = 800;
  double yaw = 0.0;
  Eigen::Vector3d t = Eigen::Vector3d::Zero();
  double mean_abs_yaw = 0.0, mean_abs_bare = 0.0;
  for (std::uint64_t seed = 1; seed <= kTrials; ++seed) {
    Random random(seed);
    const View view = random_view(random, plain_camera(), 1.0);
    const std::vector<PointPair> pairs = inlier_pairs(random, view.H, 60, 0.7, 0.7);
    bool ok = false;
    const Outcome outcome = solve(pairs, ok);
    ASSERT_TRUE(ok) << "seed " << seed;
    const double truth = yaw_of_rotation(view.R);
    yaw += std::pow((outcome.pose.yaw_rad - truth) / outcome.pose.yaw_sigma_rad, 2);
    mean_abs_yaw += std::abs(outcome.pose.yaw_rad - truth) / kTrials;
    mean_abs_bare += std::abs(outcome.bare_yaw_rad - truth) / kTrials;
    t += (outcome.pose.motion.t_over_d - view.t_over_d)
             .cwiseQuotient(outcome.pose.t_over_d_sigma)
             .array()
             .square()
             .matrix();
  }
  std::cout << "mean |yaw error| " << mean_abs_yaw * 180 / M_PI << " deg, of the decomposition alone "
            << mean_abs_bare * 180 / M_PI << " deg; normalised error squared: yaw " << yaw / kTrials << ", t "
            << t.transpose() / kTrials << "\n";
  const double band = 1.96 * std::sqrt(2.0 / kTrials) + 0.05;
  EXPECT_NEAR(yaw / kTrials, 1.0, band);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(t(i) / kTrials, 1.0, band) << "axis " << i;
  EXPECT_LT(mean_abs_yaw, 0.7 * mean_abs_bare);
}

// If the plane is small in the image and nearly frontal, the two minima have similar costs, and the wrong one
// may be chosen. Sigma includes that: errors beyond three sigma are rare, and the ambiguity is reported.
TEST(FrontalPose, SigmaIncludesTheAmbiguity) {
  constexpr int kTrials = 600;
  int solved = 0, beyond = 0, flipped = 0, ambiguous = 0;
  double squared = 0.0;
  for (std::uint64_t seed = 1; seed <= kTrials; ++seed) {
    Random random(seed);
    const double yaw = random.uniform(-0.4, 0.4);
    const Eigen::Matrix3d R = test::rotation(yaw, 0.0, 0.0);
    const Eigen::Vector3d t = Eigen::Vector3d(0, 0, 3.0) - R.col(2);  // three times the template's distance
    const Eigen::Matrix3d H = test::homography_of(plain_camera().K(), plain_camera().K(), R, t);
    bool ok = false;
    const Outcome outcome = solve(inlier_pairs(random, H, 40, 0.5, 0.5), ok);
    if (!ok) continue;
    ++solved;
    const double error = outcome.pose.yaw_rad - yaw;
    beyond += std::abs(error) > 3.0 * outcome.pose.yaw_sigma_rad;
    flipped += std::abs(yaw) > 0.1 && outcome.pose.yaw_rad * yaw < 0.0;
    ambiguous += outcome.pose.ambiguity > 0.05;
    squared += std::pow(error / outcome.pose.yaw_sigma_rad, 2) / kTrials;
  }
  std::cout << "far and frontal: " << flipped << " of " << kTrials << " flipped, " << ambiguous
            << " known to be ambiguous, " << beyond << " beyond 3 sigma; normalised error squared " << squared
            << "\n";
  EXPECT_GT(solved, kTrials * 9 / 10);
  EXPECT_GT(flipped, 5);  // the case is difficult, as intended
  EXPECT_GT(ambiguous, flipped);
  EXPECT_LT(beyond, kTrials * 3 / 100);
  EXPECT_LT(squared, 2.0);
}

TEST(FrontalPose, MirroredStartKeepsTheCentreInPlace) {
  Random random(5);
  const View view = random_view(random, plain_camera());
  const Eigen::Matrix3d K = plain_camera().K();
  const FrontalProblem problem{{}, K, K, view.H, {300.0, 200.0}};
  FrontalMotion motion;
  motion.R_cur_from_ref = view.R;
  motion.t_over_d = view.t_over_d;
  const PlaneMotion other = mirrored_motion(problem, motion);
  const Eigen::Vector3d centre = K.inverse() * Eigen::Vector3d(300.0, 200.0, 1.0);
  const Eigen::Vector3d here = view.R * centre + view.t_over_d;
  EXPECT_LT((other.R_cur_from_ref * centre + other.t_over_d - here).norm(), 1e-12);
  // The same angle to the line of sight, on the other side.
  EXPECT_NEAR(other.R_cur_from_ref.col(2).dot(here), view.R.col(2).dot(here), 1e-12);
  EXPECT_GT((other.R_cur_from_ref.col(2) - view.R.col(2)).norm(), 1e-3);
}

TEST(FrontalPose, AllocatesNothing) {
  if (!test::counts_allocations()) GTEST_SKIP() << "a sanitizer owns the allocator";
  Random random(6);
  const View view = random_view(random, plain_camera());
  const std::vector<PointPair> pairs = inlier_pairs(random, view.H, 60, 0.7, 0.7);
  const Eigen::Matrix3d K = plain_camera().K();
  const PlaneMotions motions = decompose_plane_motion(K.inverse() * view.H * K);
  FrontalPoseEstimator estimator(pairs.size());
  const std::uint64_t before = test::allocations_of_this_thread();
  const FrontalPose pose = estimator.estimate({pairs, K, K, view.H, {320.0, 240.0}}, motions.motions[0]);
  EXPECT_EQ(test::allocations_of_this_thread() - before, 0u);
  EXPECT_GT(pose.yaw_sigma_rad, 0.0);
}

}  // namespace
}  // namespace heel
