// The solvers that RANSAC is made of: DLT, four points, refinement and its covariance.
#include "heel/homography.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/LU>
#include <limits>

#include "vision/homography/homography_4pt.h"
#include "vision/homography/homography_refine.h"
#include "vision/pose/scene.h"

namespace heel {
namespace {

using test::corner_error_px;
using test::inlier_pairs;
using test::mapped;
using test::plain_camera;
using test::Random;
using test::random_view;
using test::View;

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

RC_GTEST_PROP(HomographyDlt, ExactFromFourOrMorePairs, (std::uint64_t seed)) {
  Random random(seed);
  const View view = random_view(random, plain_camera());
  const int count = 4 + static_cast<int>(seed % 60);
  std::vector<PointPair> pairs = inlier_pairs(random, view.H, count, 0.0, 0.0);
  Eigen::Matrix3d H;
  const HomographyStatus status = homography_dlt(pairs, H);
  if (count < 8) RC_PRE(status == HomographyStatus::Ok);  // a few random points may be nearly collinear
  RC_ASSERT(status == HomographyStatus::Ok);
  RC_ASSERT(H(2, 2) == 1.0);
  for (const PointPair& pair : pairs) RC_ASSERT((mapped(H, pair.ref_px) - pair.cur_px).norm() < 1e-5);
}

TEST(HomographyDlt, NamesEveryDegeneracy) {
  Eigen::Matrix3d H;
  const std::vector<PointPair> three(3);
  EXPECT_EQ(homography_dlt(three, H), HomographyStatus::TooFewPairs);

  std::vector<PointPair> same(10, PointPair{{5, 5}, {7, 7}});
  EXPECT_EQ(homography_dlt(same, H), HomographyStatus::Degenerate);

  std::vector<PointPair> line;  // all on one line, in both views
  for (int i = 0; i < 10; ++i) line.push_back({{i * 10.0, i * 5.0 + 3.0}, {i * 8.0 + 1.0, i * 2.0}});
  EXPECT_EQ(homography_dlt(line, H), HomographyStatus::Degenerate);

  const std::vector<PointPair> three_of_four = {
      {{0, 0}, {10, 10}}, {{50, 0}, {60, 10}}, {{100, 0}, {110, 10}}, {{30, 80}, {40, 90}}};
  EXPECT_EQ(homography_dlt(three_of_four, H), HomographyStatus::Degenerate);

  const std::vector<PointPair> in_one_view = {
      {{0, 0}, {10, 10}}, {{50, 5}, {60, 10}}, {{100, 0}, {110, 10}}, {{30, 80}, {40, 90}}};
  EXPECT_EQ(homography_dlt(in_one_view, H), HomographyStatus::Degenerate);
}

TEST(HomographyDlt, NormalisationMakesItIndependentOfTheUnit) {
  Random random(7);
  const View view = random_view(random, plain_camera());
  std::vector<PointPair> pairs = inlier_pairs(random, view.H, 30, 0.5, 0.5);
  Eigen::Matrix3d H, H_scaled;
  ASSERT_EQ(homography_dlt(pairs, H), HomographyStatus::Ok);
  for (PointPair& pair : pairs) {
    pair.ref_px = 1000.0 * pair.ref_px + Eigen::Vector2d(1e5, -3e5);
    pair.cur_px = 1e-3 * pair.cur_px;
  }
  ASSERT_EQ(homography_dlt(pairs, H_scaled), HomographyStatus::Ok);
  const Eigen::Vector2d probe(300, 200);
  const Eigen::Vector2d image = 1e3 * mapped(H_scaled, 1000.0 * probe + Eigen::Vector2d(1e5, -3e5));
  EXPECT_LT((image - mapped(H, probe)).norm(), 1e-6);
}

RC_GTEST_PROP(Homography4pt, ExactAndSignedLikeTheTruth, (std::uint64_t seed)) {
  Random random(seed);
  const View view = random_view(random, plain_camera());
  std::array<Eigen::Vector2d, 4> ref, cur;
  for (std::size_t i = 0; i < 4; ++i) {
    ref[i] = {random.uniform(220, 420), random.uniform(90, 390)};
    cur[i] = mapped(view.H, ref[i]);
  }
  Eigen::Matrix3d H;
  RC_PRE(homography_4pt(ref, cur, H));
  RC_ASSERT(H.determinant() > 0.0);
  for (std::size_t i = 0; i < 4; ++i) {
    RC_ASSERT((H * ref[i].homogeneous()).z() > 0.0);
    RC_ASSERT((mapped(H, ref[i]) - cur[i]).norm() < 1e-6);
  }
  RC_ASSERT(corner_error_px(H, view.H) <
            0.1);  // four points that pass kCollinear amplify rounding errors by a bounded factor
}

TEST(Homography4pt, RefusesLinesMirrorsAndFolds) {
  const std::array<Eigen::Vector2d, 4> square = {Eigen::Vector2d(0, 0), {100, 0}, {100, 100}, {0, 100}};
  Eigen::Matrix3d H;
  EXPECT_TRUE(homography_4pt(square, square, H));
  const std::array<Eigen::Vector2d, 4> line = {Eigen::Vector2d(0, 0), {50, 0}, {100, 0}, {0, 100}};
  EXPECT_FALSE(homography_4pt(line, square, H));
  EXPECT_FALSE(homography_4pt(square, line, H));
  const std::array<Eigen::Vector2d, 4> mirrored = {Eigen::Vector2d(100, 0), {0, 0}, {0, 100}, {100, 100}};
  EXPECT_FALSE(homography_4pt(square, mirrored, H));
  const std::array<Eigen::Vector2d, 4> folded = {Eigen::Vector2d(0, 0), {100, 0}, {0, 100}, {100, 100}};
  EXPECT_FALSE(homography_4pt(square, folded, H));
  const std::array<Eigen::Vector2d, 4> dented = {Eigen::Vector2d(0, 0), {100, 0}, {30, 30}, {0, 100}};
  EXPECT_FALSE(homography_4pt(square, dented, H));
}

TEST(HomographyError, IsTheSumOfBothDirections) {
  const Eigen::Matrix3d H = Eigen::DiagonalMatrix<double, 3>(2.0, 2.0, 1.0);
  const PointPair pair{{10, 0}, {24, 0}};  // forward 4 px off, backward 2 px
  EXPECT_DOUBLE_EQ(symmetric_transfer_error_px2(H, H.inverse(), pair), 16.0 + 4.0);
}

TEST(RefineHomography, FindsTheMinimumOfTheSymmetricTransferError) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    Random random(seed);
    const View view = random_view(random, plain_camera());
    std::vector<PointPair> pairs = inlier_pairs(random, view.H, 25, 1.0, 1.0);
    const Eigen::Vector2d ref_centre(320, 240), cur_centre = mapped(view.H, ref_centre);
    for (PointPair& pair : pairs) pair = {pair.ref_px - ref_centre, pair.cur_px - cur_centre};
    Eigen::Matrix3d H;
    ASSERT_EQ(homography_dlt(pairs, H), HomographyStatus::Ok);
    const double cost = refine_homography(pairs, kNoLimit, H);
    // A change of any entry, in either direction, increases the cost.
    for (int i = 0; i < 8; ++i) {
      for (const double relative : {1e-4, -1e-4}) {
        Eigen::Matrix3d other = H;
        other(i / 3, i % 3) *= 1.0 + relative;
        double sum = 0.0;
        for (const PointPair& pair : pairs) sum += symmetric_transfer_error_px2(other, other.inverse(), pair);
        EXPECT_GE(sum, cost * (1.0 - 1e-6)) << "seed " << seed << " entry " << i;
      }
    }
  }
}

// The squared error of the four corners of the region, normalised by the stated covariance, over many trials:
// its mean and spread are those of χ².
TEST(HomographyPrecision, CovarianceIsThatOfTheErrors) {
  constexpr int kTrials = 600;
  for (const auto& [noise_cur, noise_ref] : {std::pair{0.5, 0.5}, std::pair{1.0, 1.0}}) {
    double sum_squared = 0.0, noise = 0.0;
    for (std::uint64_t seed = 1; seed <= kTrials; ++seed) {
      Random random(seed);
      const View view = random_view(random, plain_camera(), 0.8);
      const std::vector<PointPair> pairs = inlier_pairs(random, view.H, 60, noise_cur, noise_ref);
      Eigen::Matrix3d H;
      ASSERT_EQ(homography_dlt(pairs, H), HomographyStatus::Ok);
      refine_homography(pairs, kNoLimit, H);
      H /= H(2, 2);
      const HomographyPrecision precision = homography_precision(pairs, H);
      noise += precision.noise_px / kTrials;
      Eigen::Matrix<double, 8, 1> error;
      const Eigen::Matrix3d difference = view.H / view.H(2, 2) - H;
      for (int i = 0; i < 8; ++i) error(i) = difference(i / 3, i % 3);
      const Eigen::Matrix<double, 8, 8> covariance = precision.covariance.topLeftCorner<8, 8>();
      sum_squared += error.dot(covariance.fullPivLu().solve(error));
    }
    // χ² with 8 degrees of freedom for each trial; the spread of the noise estimate adds a little.
    const double mean = sum_squared / kTrials;
    EXPECT_NEAR(mean, 8.0, 8.0 * 0.12) << "noise " << noise_cur;
    EXPECT_NEAR(noise, noise_cur, 0.05 * noise_cur);
  }
}

}  // namespace
}  // namespace heel
