#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <opencv2/calib3d.hpp>

#include "heel/homography.h"
#include "support/allocation_count.h"
#include "vision/pose/scene.h"

namespace heel {
namespace {

using test::add_outliers;
using test::corner_error_px;
using test::inlier_pairs;
using test::plain_camera;
using test::Random;
using test::random_view;
using test::View;

struct Problem {
  View view;
  std::vector<PointPair> pairs;
  int inliers;
};

Problem problem(std::uint64_t seed, int pairs, double wrong, double noise_px) {
  Random random(seed);
  Problem problem;
  problem.view = random_view(random, plain_camera());
  problem.inliers = pairs - static_cast<int>(std::lround(wrong * pairs));
  problem.pairs = inlier_pairs(random, problem.view.H, problem.inliers, noise_px, 0.0);
  add_outliers(random, problem.pairs, pairs - problem.inliers);
  std::shuffle(problem.pairs.begin(), problem.pairs.end(), random.engine);
  return problem;
}

Eigen::Matrix3d opencv_homography(const std::vector<PointPair>& pairs, int method) {
  std::vector<cv::Point2f> ref, cur;
  for (const PointPair& pair : pairs) {
    ref.emplace_back(static_cast<float>(pair.ref_px.x()), static_cast<float>(pair.ref_px.y()));
    cur.emplace_back(static_cast<float>(pair.cur_px.x()), static_cast<float>(pair.cur_px.y()));
  }
  const cv::Mat found = cv::findHomography(ref, cur, method, 3.0, cv::noArray(), 2000, 0.999);
  Eigen::Matrix3d H = Eigen::Matrix3d::Identity();
  for (int i = 0; i < 9 && !found.empty(); ++i) H(i / 3, i % 3) = found.at<double>(i / 3, i % 3);
  return H;
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

TEST(HomographyEstimator, HalfWrongOverAThousandProblemsNoWorseThanMagsac) {
  std::vector<double> ours, theirs;
  std::vector<std::uint8_t> mask;
  HomographyEstimator estimator(200, RansacSettings{});
  for (std::uint64_t seed = 1; seed <= 1000; ++seed) {
    const Problem p = problem(seed, 200, 0.5, 1.0);
    const RobustHomography result = estimator.estimate(p.pairs, mask);
    ASSERT_EQ(result.status, HomographyStatus::Ok) << "seed " << seed;
    ours.push_back(corner_error_px(result.H_cur_from_ref, p.view.H));
    theirs.push_back(corner_error_px(opencv_homography(p.pairs, cv::USAC_MAGSAC), p.view.H));
    EXPECT_LT(ours.back(), 6.0) << "seed " << seed;
  }
  RecordProperty("mean_px", std::to_string(mean(ours)));
  RecordProperty("magsac_mean_px", std::to_string(mean(theirs)));
  std::cout << "corner error px: mean " << mean(ours) << " median " << median(ours) << "; USAC_MAGSAC mean "
            << mean(theirs) << " median " << median(theirs) << "\n";
  EXPECT_LE(mean(ours), mean(theirs));
  EXPECT_LE(median(ours), median(theirs));
}

TEST(HomographyEstimator, StillRightWithEightyPercentWrong) {
  RansacSettings settings;
  settings.max_iterations = 10000;
  HomographyEstimator estimator(250, settings);
  std::vector<std::uint8_t> mask;
  std::vector<double> errors;
  int right = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    const Problem p = problem(seed, 250, 0.8, 1.0);
    const RobustHomography result = estimator.estimate(p.pairs, mask);
    errors.push_back(corner_error_px(result.H_cur_from_ref, p.view.H));
    if (result.status == HomographyStatus::Ok && errors.back() < 5.0) ++right;
  }
  std::cout << "80 % wrong: " << right << " of 300 right, median corner error " << median(errors) << " px\n";
  EXPECT_GE(right, 299);
}

TEST(HomographyEstimator, MaskSaysWhichPairsSupport) {
  const Problem p = problem(3, 200, 0.4, 0.7);
  HomographyEstimator estimator(200, RansacSettings{});
  std::vector<std::uint8_t> mask;
  const RobustHomography result = estimator.estimate(p.pairs, mask);
  ASSERT_EQ(result.status, HomographyStatus::Ok);
  ASSERT_EQ(mask.size(), p.pairs.size());
  const Eigen::Matrix3d inverse = result.H_cur_from_ref.inverse();
  int supporting = 0;
  for (std::size_t i = 0; i < mask.size(); ++i) {
    const double error = symmetric_transfer_error_px2(result.H_cur_from_ref, inverse, p.pairs[i]);
    EXPECT_EQ(mask[i] != 0, error < 18.0) << "pair " << i;
    supporting += mask[i];
  }
  EXPECT_EQ(supporting, result.inliers);
  EXPECT_NEAR(supporting, p.inliers, 8);
  EXPECT_NEAR(result.rms_px, 0.7 * std::sqrt(2.0), 0.15);
  EXPECT_DOUBLE_EQ(result.H_cur_from_ref(2, 2), 1.0);
}

TEST(HomographyEstimator, SameInputSameResultToTheBit) {
  const Problem p = problem(11, 120, 0.6, 1.0);
  const Problem other = problem(12, 90, 0.3, 1.0);
  HomographyEstimator first(120, RansacSettings{}), second(150, RansacSettings{});
  std::vector<std::uint8_t> mask;
  const RobustHomography a = first.estimate(p.pairs, mask);
  second.estimate(other.pairs, mask);  // earlier calls have no effect
  const RobustHomography b = second.estimate(p.pairs, mask);
  ASSERT_EQ(a.status, HomographyStatus::Ok);
  EXPECT_EQ(b.status, HomographyStatus::Ok);
  EXPECT_EQ(a.H_cur_from_ref, b.H_cur_from_ref);
  EXPECT_EQ(a.covariance, b.covariance);
  EXPECT_EQ(a.iterations, b.iterations);
}

TEST(HomographyEstimator, StopsEarlyWhenMostPairsAgree) {
  HomographyEstimator estimator(200, RansacSettings{});
  std::vector<std::uint8_t> mask;
  EXPECT_LT(estimator.estimate(problem(5, 200, 0.1, 0.5).pairs, mask).iterations, 20);
  EXPECT_LT(estimator.estimate(problem(5, 200, 0.5, 0.5).pairs, mask).iterations, 250);
}

TEST(HomographyEstimator, NamesTheReason) {
  HomographyEstimator estimator(100, RansacSettings{});
  std::vector<std::uint8_t> mask;
  EXPECT_EQ(estimator.estimate({}, mask).status, HomographyStatus::TooFewPairs);
  EXPECT_EQ(estimator.estimate(problem(1, 3, 0.0, 0.0).pairs, mask).status, HomographyStatus::TooFewPairs);

  std::vector<PointPair> line;
  for (int i = 0; i < 50; ++i) line.push_back({{i * 3.0, i * 2.0}, {i * 3.0 + 5.0, i * 2.0}});
  EXPECT_EQ(estimator.estimate(line, mask).status, HomographyStatus::Degenerate);
  const std::vector<PointPair> same(50, PointPair{{1, 2}, {3, 4}});
  EXPECT_EQ(estimator.estimate(same, mask).status, HomographyStatus::Degenerate);

  // Six unrelated pairs: at most five agree by chance.
  int no_consensus = 0;
  for (std::uint64_t seed = 1; seed <= 50; ++seed)
    no_consensus += estimator.estimate(problem(seed, 6, 1.0, 0.0).pairs, mask).status != HomographyStatus::Ok;
  EXPECT_GE(no_consensus, 45);
}

TEST(HomographyEstimator, MirroredPlaneIsNotAView) {
  Random random(4);
  std::vector<PointPair> pairs;
  for (int i = 0; i < 60; ++i) {
    const Eigen::Vector2d ref(random.uniform(220, 420), random.uniform(90, 390));
    pairs.push_back({ref, {640.0 - ref.x(), ref.y()}});
  }
  HomographyEstimator estimator(60, RansacSettings{});
  std::vector<std::uint8_t> mask;
  const RobustHomography result = estimator.estimate(pairs, mask);
  EXPECT_TRUE(result.status != HomographyStatus::Ok || result.inliers < 20);
}

TEST(HomographyEstimator, IgnoresPairsBeyondItsMemory) {
  const Problem p = problem(8, 300, 0.2, 0.5);
  HomographyEstimator estimator(100, RansacSettings{});
  std::vector<std::uint8_t> mask;
  const RobustHomography result = estimator.estimate(p.pairs, mask);
  ASSERT_EQ(result.status, HomographyStatus::Ok);
  EXPECT_EQ(mask.size(), 300u);
  EXPECT_LE(result.inliers, 100);
  EXPECT_EQ(std::count(mask.begin() + 100, mask.end(), 1), 0);
}

TEST(HomographyEstimator, IterationBoundReturnsTheBestSoFar) {
  RansacSettings settings;
  settings.max_iterations = 500;
  settings.confidence = 1.0 - 1e-15;  // needs 8,800 samples with a quarter of the pairs right
  HomographyEstimator estimator(1000, settings);
  std::vector<std::uint8_t> mask;
  const Problem p = problem(2, 1000, 0.75, 1.0);
  const RobustHomography result = estimator.estimate(p.pairs, mask);
  EXPECT_EQ(result.iterations, settings.max_iterations);
  EXPECT_EQ(result.status, HomographyStatus::Ok);
  EXPECT_LT(corner_error_px(result.H_cur_from_ref, p.view.H), 3.0);
}

TEST(HomographyEstimator, AllocatesNothing) {
  if (!test::counts_allocations()) GTEST_SKIP() << "a sanitizer owns the allocator";
  const Problem p = problem(9, 200, 0.5, 1.0);
  HomographyEstimator estimator(200, RansacSettings{});
  std::vector<std::uint8_t> mask;
  mask.reserve(200);
  const std::uint64_t before = test::allocations_of_this_thread();
  const RobustHomography result = estimator.estimate(p.pairs, mask);
  EXPECT_EQ(test::allocations_of_this_thread() - before, 0u);
  EXPECT_EQ(result.status, HomographyStatus::Ok);
}

}  // namespace
}  // namespace heel
