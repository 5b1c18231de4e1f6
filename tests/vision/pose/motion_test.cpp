#include "heel/motion.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <opencv2/calib3d.hpp>

#include "vision/pose/scene.h"

namespace heel {
namespace {

using test::Random;
using test::rotation;

const std::vector<Eigen::Vector2d> kRegion = {{-0.2, -0.3}, {0.2, -0.3}, {0.2, 0.3}, {-0.2, 0.3}, {0.0, 0.0}};

Eigen::Matrix3d random_rotation(Random& random, double max_angle_rad) {
  return Eigen::AngleAxisd(random.uniform(-max_angle_rad, max_angle_rad), random.direction())
      .toRotationMatrix();
}

Eigen::Matrix3d composed(const PlaneMotion& motion) {
  return motion.R_cur_from_ref + motion.t_over_d * motion.normal_ref.transpose();
}

/// Distance of A and B as projective matrices (scale and sign free).
double apart(const Eigen::Matrix3d& A, const Eigen::Matrix3d& B) {
  const Eigen::Matrix3d a = A / A.norm(), b = B / B.norm();
  return std::min((a - b).norm(), (a + b).norm());
}

double apart(const PlaneMotion& motion, const Eigen::Matrix3d& R, const Eigen::Vector3d& t,
             const Eigen::Vector3d& n) {
  return (motion.R_cur_from_ref - R).norm() + (motion.t_over_d - t).norm() + (motion.normal_ref - n).norm();
}

double nearest(const PlaneMotions& motions, const Eigen::Matrix3d& R, const Eigen::Vector3d& t,
               const Eigen::Vector3d& n) {
  double best = 1e9;
  for (int i = 0; i < motions.count; ++i)
    best = std::min(best, apart(motions.motions[static_cast<std::size_t>(i)], R, t, n));
  return best;
}

void expect_all_explain(const PlaneMotions& motions, const Eigen::Matrix3d& A, double tolerance) {
  for (int i = 0; i < motions.count; ++i) {
    const PlaneMotion& motion = motions.motions[static_cast<std::size_t>(i)];
    EXPECT_LT(apart(composed(motion), A), tolerance) << "solution " << i;
    EXPECT_NEAR(motion.R_cur_from_ref.determinant(), 1.0, 1e-9);
    EXPECT_LT(
        (motion.R_cur_from_ref * motion.R_cur_from_ref.transpose() - Eigen::Matrix3d::Identity()).norm(),
        1e-9);
    EXPECT_NEAR(motion.normal_ref.norm(), 1.0, 1e-9);
    EXPECT_EQ(motion.same_side, composed(motion).determinant() > 0.0) << "solution " << i;
  }
}

RC_GTEST_PROP(PlaneMotion, DistinctGivesEightSolutionsThatExplainAWithTheTruthAmongThem,
              (std::uint64_t seed)) {
  Random random(seed);
  const Eigen::Matrix3d R = random_rotation(random, 3.1);
  const Eigen::Vector3d t = random.uniform(0.1, 3.0) * random.direction();
  const Eigen::Vector3d n = random.direction();
  const Eigen::Matrix3d A = R + t * n.transpose();
  RC_PRE(std::abs(A.determinant()) > 0.05);
  const double scale = random.uniform(-5.0, 5.0);
  RC_PRE(std::abs(scale) > 0.01);
  const PlaneMotions motions = decompose_plane_motion(scale * A);
  RC_PRE(motions.kind == PlaneMotionCase::Distinct);
  RC_ASSERT(motions.count == 8);
  RC_ASSERT(nearest(motions, R, t, n) < 1e-5);
  expect_all_explain(motions, A, 1e-9);
}

TEST(PlaneMotion, ChoiceFindsTheTruthOverRandomMotionsAndPlanes) {
  int tried = 0, right = 0, runner_up = 0;
  for (std::uint64_t seed = 1; seed <= 5000; ++seed) {
    Random random(seed);
    const Eigen::Matrix3d R = random_rotation(random, 1.2);
    const Eigen::Vector3d t = random.uniform(0.1, 1.0) * random.direction();
    const Eigen::Vector3d n =
        rotation(random.uniform(-0.9, 0.9), random.uniform(-0.6, 0.6), 0) * Eigen::Vector3d::UnitZ();
    const Eigen::Matrix3d A = R + t * n.transpose();
    if (A.determinant() < 0.05) continue;  // the second camera in or behind the plane
    bool visible = true;
    for (const Eigen::Vector2d& point : kRegion) {
      const double inverse_depth = n.dot(point.homogeneous());
      visible = visible && inverse_depth > 0.05 && (R * point.homogeneous() / inverse_depth + t).z() > 0.05;
    }
    if (!visible) continue;
    ++tried;
    const PlaneMotions motions = decompose_plane_motion(-2.5 * A);
    const MotionChoice choice = choose_motion(motions, kRegion, n);
    ASSERT_GE(choice.best, 0) << "seed " << seed;
    right += apart(motions.motions[static_cast<std::size_t>(choice.best)], R, t, n) < 1e-5;
    if (choice.second < 0) continue;
    ++runner_up;
    const PlaneMotion& second = motions.motions[static_cast<std::size_t>(choice.second)];
    EXPECT_GT(apart(second, R, t, n), 1e-6);
    EXPECT_LT(apart(composed(second), A), 1e-9);
  }
  EXPECT_GT(tried, 1000);
  EXPECT_GT(runner_up, tried / 2);
  EXPECT_EQ(right, tried);
}

TEST(PlaneMotion, FourAreOnTheSameSideAndTwoOfThemInFront) {
  Random random(77);
  const Eigen::Matrix3d A =
      rotation(0.4, 0.1, 0.05) + Eigen::Vector3d(0.3, 0.1, -0.2) * Eigen::RowVector3d(0, 0, 1);
  const PlaneMotions motions = decompose_plane_motion(A);
  ASSERT_EQ(motions.kind, PlaneMotionCase::Distinct);
  EXPECT_EQ(std::count_if(motions.motions.begin(), motions.motions.end(),
                          [](const auto& m) { return m.same_side; }),
            4);
  const MotionChoice choice = choose_motion(motions, kRegion);
  EXPECT_GE(choice.best, 0);
  EXPECT_GE(choice.second, 0);
}

// OpenCV uses another method, the closed form of Malis and Vargas, and returns the four same-side solutions.
TEST(PlaneMotion, AgreesWithOpenCv) {
  int compared = 0;
  for (std::uint64_t seed = 1; seed <= 1000; ++seed) {
    Random random(seed);
    const Eigen::Matrix3d R = random_rotation(random, 1.2);
    const Eigen::Vector3d t = random.uniform(0.1, 0.8) * random.direction();
    const Eigen::Vector3d n = random.direction();
    const Eigen::Matrix3d A = R + t * n.transpose();
    if (A.determinant() < 0.1) continue;
    const PlaneMotions ours = decompose_plane_motion(A);
    if (ours.kind != PlaneMotionCase::Distinct) continue;
    cv::Matx33d H;
    for (int i = 0; i < 9; ++i) H.val[i] = A(i / 3, i % 3);
    std::vector<cv::Mat> rotations, translations, normals;
    const int found = cv::decomposeHomographyMat(H, cv::Matx33d::eye(), rotations, translations, normals);
    ASSERT_EQ(found, 4) << "seed " << seed;
    for (std::size_t i = 0; i < 4; ++i) {
      Eigen::Matrix3d theirs_R;
      Eigen::Vector3d theirs_t, theirs_n;
      for (int k = 0; k < 9; ++k) theirs_R(k / 3, k % 3) = rotations[i].at<double>(k / 3, k % 3);
      for (int k = 0; k < 3; ++k) {
        theirs_t(k) = translations[i].at<double>(k);
        theirs_n(k) = normals[i].at<double>(k);
      }
      EXPECT_LT(nearest(ours, theirs_R, theirs_t, theirs_n), 1e-5) << "seed " << seed << " solution " << i;
    }
    ++compared;
  }
  EXPECT_GT(compared, 500);
}

TEST(PlaneMotion, TwoEqualIsATranslationAlongTheNormal) {
  for (std::uint64_t seed = 1; seed <= 500; ++seed) {
    Random random(seed);
    const Eigen::Matrix3d R = random_rotation(random, 1.0);
    const Eigen::Vector3d n = random.direction();
    // t = k R n: A = R (I + k n nᵀ), singular values 1, 1, 1 + k. Farther (k > 0) and nearer (k < 0).
    const double k = (seed % 2 == 0 ? 1.0 : -1.0) * random.uniform(0.05, 0.9);
    const Eigen::Vector3d t = k * R * n;
    const Eigen::Matrix3d A = R + t * n.transpose();
    const PlaneMotions motions = decompose_plane_motion(3.0 * A);
    ASSERT_EQ(motions.kind, PlaneMotionCase::TwoEqual) << "seed " << seed;
    EXPECT_EQ(motions.count, 4);
    EXPECT_LT(nearest(motions, R, t, n), 1e-6) << "seed " << seed;
    EXPECT_LT(nearest(motions, R, -t, -n), 1e-6) << "seed " << seed;
    expect_all_explain(motions, A, 1e-6);
  }
}

TEST(PlaneMotion, TwoEqualIsChosenCorrectly) {
  const Eigen::Matrix3d R = rotation(0.2, -0.1, 0.05);
  const Eigen::Vector3d t = -0.4 * R.col(2);
  const PlaneMotions motions = decompose_plane_motion(R + t * Eigen::RowVector3d(0, 0, 1));
  ASSERT_EQ(motions.kind, PlaneMotionCase::TwoEqual);
  const MotionChoice choice = choose_motion(motions, kRegion);
  ASSERT_GE(choice.best, 0);
  EXPECT_EQ(choice.second, -1);
  EXPECT_LT(apart(motions.motions[static_cast<std::size_t>(choice.best)], R, t, Eigen::Vector3d::UnitZ()),
            1e-7);
}

TEST(PlaneMotion, AllEqualIsAPureRotation) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Random random(seed);
    const Eigen::Matrix3d R = random_rotation(random, seed == 1 ? 0.0 : 0.8);
    const PlaneMotions motions = decompose_plane_motion((seed % 2 == 0 ? 4.0 : -4.0) * R);
    ASSERT_EQ(motions.kind, PlaneMotionCase::PureRotation);
    ASSERT_EQ(motions.count, 1);
    EXPECT_LT((motions.motions[0].R_cur_from_ref - R).norm(), 1e-9);
    EXPECT_EQ(motions.motions[0].t_over_d.norm(), 0.0);
  }
  // The rotation is chosen although its normal is undetermined: the known normal is used instead.
  const MotionChoice choice =
      choose_motion(decompose_plane_motion(rotation(0.3, 0.0, 0.0)), kRegion, Eigen::Vector3d(0.6, 0.0, 0.8));
  EXPECT_EQ(choice.best, 0);
  EXPECT_EQ(choice.second, -1);
}

TEST(PlaneMotion, DegenerateMatricesGiveNoMotion) {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  EXPECT_EQ(decompose_plane_motion(A).kind, PlaneMotionCase::Degenerate);
  A = Eigen::Vector3d(1, 2, 3) * Eigen::RowVector3d(1, 0, 1);
  EXPECT_EQ(decompose_plane_motion(A).kind, PlaneMotionCase::Degenerate);
  A = Eigen::DiagonalMatrix<double, 3>(1.0, 1.0, 1e-9);  // the second camera in the plane
  EXPECT_EQ(decompose_plane_motion(A).kind, PlaneMotionCase::Degenerate);
  A = Eigen::Matrix3d::Identity();
  A(1, 2) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(decompose_plane_motion(A).kind, PlaneMotionCase::Degenerate);
  A(1, 2) = std::numeric_limits<double>::infinity();
  EXPECT_EQ(decompose_plane_motion(A).kind, PlaneMotionCase::Degenerate);
  EXPECT_EQ(decompose_plane_motion(A).count, 0);
  EXPECT_EQ(choose_motion(decompose_plane_motion(A), kRegion).best, -1);
}

// Across each boundary between two cases the solution changes by no more than the width of the boundary.
TEST(PlaneMotion, ContinuousAcrossTheBoundaries) {
  for (const double tilt : {1e-9, 1e-8, 1e-7, 5e-7, 1e-6, 2e-6, 1e-5, 1e-4, 1e-3}) {
    const Eigen::Matrix3d R = rotation(0.1, 0.05, 0.0);
    // Nearly along the normal: from TwoEqual into Distinct.
    const Eigen::Vector3d along = -0.3 * R.col(2) + tilt * R.col(0);
    PlaneMotions motions = decompose_plane_motion(R + along * Eigen::RowVector3d(0, 0, 1));
    MotionChoice choice = choose_motion(motions, kRegion);
    ASSERT_GE(choice.best, 0) << tilt;
    const PlaneMotion& near_normal = motions.motions[static_cast<std::size_t>(choice.best)];
    EXPECT_LT(apart(near_normal, R, along, Eigen::Vector3d::UnitZ()), 1e-5) << tilt;

    // Nearly no translation: from PureRotation into Distinct; the normal becomes uncertain, R and t do not.
    const Eigen::Vector3d little = tilt * Eigen::Vector3d(1.0, 0.5, -0.5);
    motions = decompose_plane_motion(R + little * Eigen::RowVector3d(0, 0, 1));
    choice = choose_motion(motions, kRegion);
    ASSERT_GE(choice.best, 0) << tilt;
    const PlaneMotion& near_still = motions.motions[static_cast<std::size_t>(choice.best)];
    EXPECT_LT((near_still.R_cur_from_ref - R).norm() + (near_still.t_over_d - little).norm(), 1e-5) << tilt;
  }
}

RC_GTEST_PROP(PlaneMotion, AnyMatrixGivesFiniteSolutions, (std::uint64_t seed)) {
  Random random(seed);
  Eigen::Matrix3d A;
  for (int i = 0; i < 9; ++i)
    A(i / 3, i % 3) = random.normal(1.0) * std::pow(10.0, random.uniform(-3.0, 3.0));
  const PlaneMotions motions = decompose_plane_motion(A);
  for (int i = 0; i < motions.count; ++i) {
    const PlaneMotion& motion = motions.motions[static_cast<std::size_t>(i)];
    RC_ASSERT(motion.R_cur_from_ref.allFinite() && motion.t_over_d.allFinite() &&
              motion.normal_ref.allFinite());
    RC_ASSERT(apart(composed(motion), A) < 1e-6);
  }
}

TEST(YawOfRotation, IsPositiveWhenTheWalkingDirectionTurnsToTheImagesRight) {
  for (const double yaw : {-1.5, -0.5, 0.0, 0.3, 1.0, 3.0}) {
    EXPECT_NEAR(yaw_of_rotation(rotation(yaw, 0.0, 0.0)), yaw, 1e-12);
    EXPECT_NEAR(yaw_of_rotation(rotation(yaw, 0.2, 0.0)), yaw, 1e-12);
    EXPECT_NEAR(yaw_of_rotation(rotation(yaw, 0.2, -0.4)), yaw, 1e-12);
  }
  // With positive yaw the right edge of the back comes nearer.
  const Eigen::Vector3d right_edge = rotation(0.5, 0.0, 0.0) * Eigen::Vector3d(0.2, 0.0, 0.0);
  EXPECT_LT(right_edge.z(), 0.0);
}

}  // namespace
}  // namespace heel
