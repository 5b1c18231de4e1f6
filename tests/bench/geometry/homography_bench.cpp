// Homography and motion compared with OpenCV's in the same run: 200 pairs of which a share is wrong, noise 1
// px. The argument is the share in percent. Each iteration takes the next of 64 random problems.
#include <benchmark/benchmark.h>

#include <Eigen/LU>
#include <opencv2/calib3d.hpp>
#include <vector>

#include "heel/homography.h"
#include "heel/motion.h"
#include "heel/shirt_template.h"
#include "heel/vision_config.h"
#include "vision/pose/frontal_pose_estimator.h"
#include "vision/pose/scene.h"

namespace {

using heel::PointPair;

constexpr int kPairs = 200;
constexpr double kConfidence = 0.999;
constexpr int kMaxIterations = 10000;

struct Problem {
  std::vector<PointPair> pairs;
  std::vector<cv::Point2f> ref, cur;
};

std::vector<Problem> problems(double wrong) {
  std::vector<Problem> result(64);
  std::uint64_t seed = 1;
  for (Problem& problem : result) {
    heel::test::Random random(seed++);
    const heel::test::View view = heel::test::random_view(random, heel::test::plain_camera());
    const int outliers = static_cast<int>(wrong * kPairs);
    problem.pairs = heel::test::inlier_pairs(random, view.H, kPairs - outliers, 1.0, 0.0);
    heel::test::add_outliers(random, problem.pairs, outliers);
    std::shuffle(problem.pairs.begin(), problem.pairs.end(), random.engine);
    for (const PointPair& pair : problem.pairs) {
      problem.ref.emplace_back(static_cast<float>(pair.ref_px.x()), static_cast<float>(pair.ref_px.y()));
      problem.cur.emplace_back(static_cast<float>(pair.cur_px.x()), static_cast<float>(pair.cur_px.y()));
    }
  }
  return result;
}

void heel_homography(benchmark::State& state) {
  const std::vector<Problem> all = problems(static_cast<double>(state.range(0)) / 100.0);
  heel::RansacSettings settings;
  settings.confidence = kConfidence;
  settings.max_iterations = kMaxIterations;
  heel::HomographyEstimator estimator(kPairs, settings);
  std::vector<std::uint8_t> mask;
  std::size_t next = 0;
  for (auto _ : state) benchmark::DoNotOptimize(estimator.estimate(all[next++ % all.size()].pairs, mask));
}

/// The frame that takes the most iterations: the pairs keep their order, so that most samples give a
/// homography to score, but scatter so widely that no homography has enough inliers to stop early. As many
/// pairs as the largest template gives; vision's own settings. The argument is the scatter in pixels.
void heel_homography_without_consensus(benchmark::State& state) {
  const heel::VisionConfig vision;
  const int pairs = heel::ShirtTemplate{}.max_features;
  std::vector<std::vector<PointPair>> all;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    heel::test::Random random(seed);
    const heel::test::View view = heel::test::random_view(random, heel::test::plain_camera());
    all.push_back(heel::test::inlier_pairs(random, view.H, pairs, static_cast<double>(state.range(0)), 0.0));
  }
  heel::RansacSettings settings;
  settings.inlier_px = vision.inlier_px;
  settings.max_iterations = vision.ransac_iterations;
  settings.precision = false;
  heel::HomographyEstimator estimator(pairs, settings);
  std::vector<std::uint8_t> mask;
  std::size_t next = 0;
  double iterations = 0.0;
  for (auto _ : state) iterations += estimator.estimate(all[next++ % all.size()], mask).iterations;
  state.counters["samples"] = benchmark::Counter(iterations, benchmark::Counter::kAvgIterations);
}

void opencv_homography(benchmark::State& state, int method) {
  const std::vector<Problem> all = problems(static_cast<double>(state.range(0)) / 100.0);
  std::size_t next = 0;
  for (auto _ : state) {
    const Problem& problem = all[next++ % all.size()];
    benchmark::DoNotOptimize(cv::findHomography(problem.ref, problem.cur, method, 3.0, cv::noArray(),
                                                kMaxIterations, kConfidence));
  }
}

void heel_decomposition(benchmark::State& state) {
  heel::test::Random random(1);
  const Eigen::Matrix3d K = heel::test::plain_camera().K();
  const Eigen::Matrix3d A = K.inverse() * heel::test::random_view(random, heel::test::plain_camera()).H * K;
  for (auto _ : state) benchmark::DoNotOptimize(heel::decompose_plane_motion(A));
}

void opencv_decomposition(benchmark::State& state) {
  heel::test::Random random(1);
  const Eigen::Matrix3d K = heel::test::plain_camera().K();
  const Eigen::Matrix3d A = K.inverse() * heel::test::random_view(random, heel::test::plain_camera()).H * K;
  cv::Matx33d H;
  for (int i = 0; i < 9; ++i) H.val[i] = A(i / 3, i % 3);
  std::vector<cv::Mat> R, t, n;
  for (auto _ : state) benchmark::DoNotOptimize(cv::decomposeHomographyMat(H, cv::Matx33d::eye(), R, t, n));
}

void heel_frontal_pose(benchmark::State& state) {
  heel::test::Random random(1);
  const Eigen::Matrix3d K = heel::test::plain_camera().K();
  const heel::test::View view = heel::test::random_view(random, heel::test::plain_camera());
  const std::vector<PointPair> pairs = heel::test::inlier_pairs(random, view.H, kPairs / 2, 1.0, 0.0);
  const heel::PlaneMotion start{view.R, view.t_over_d, Eigen::Vector3d::UnitZ(), true};
  heel::FrontalPoseEstimator estimator(pairs.size());
  for (auto _ : state)
    benchmark::DoNotOptimize(estimator.estimate({pairs, K, K, view.H, {320.0, 240.0}}, start));
}

BENCHMARK(heel_homography)->Arg(20)->Arg(50)->Arg(80)->Arg(100)->Unit(benchmark::kMicrosecond);
BENCHMARK(heel_homography_without_consensus)->Arg(5)->Arg(10)->Arg(20)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(opencv_homography, usac_magsac, static_cast<int>(cv::USAC_MAGSAC))
    ->Arg(20)
    ->Arg(50)
    ->Arg(80)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(opencv_homography, ransac, static_cast<int>(cv::RANSAC))
    ->Arg(20)
    ->Arg(50)
    ->Arg(80)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK(heel_decomposition)->Unit(benchmark::kMicrosecond);
BENCHMARK(opencv_decomposition)->Unit(benchmark::kMicrosecond);
BENCHMARK(heel_frontal_pose)->Unit(benchmark::kMicrosecond);

}  // namespace
