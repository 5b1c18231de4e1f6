// Features and matching, each with its reference algorithm. Compare times of one run only. The label holds
// what was found: counters would have to be the same for all benchmarks, or the CSV reporter refuses them.
#include <benchmark/benchmark.h>

#include <opencv2/features2d.hpp>
#include <string>

#include "bench/vision/bench_images.h"
#include "heel/features.h"
#include "heel/matching.h"
#include "vision/features/descriptor.h"
#include "vision/features/fast_hessian.h"
#include "vision/features/integral_image.h"
#include "vision/features/keypoint_selection.h"
#include "vision/features/orientation.h"

namespace heel::evaluation {
namespace {

void extract_repeatedly(benchmark::State& state, const cv::Mat& grey, const FeatureSettings& settings,
                        const Region& region = {}) {
  FeatureExtractor extractor(grey.cols, grey.rows, settings);
  FeatureSet features;
  extractor.reserve(features);
  for (auto _ : state) extractor.extract(view_of(grey), region, features);
  state.SetLabel(std::to_string(features.features.size()) + " features");
}

void features_upright(benchmark::State& state) {
  extract_repeatedly(state, textured_image(), {});
}
void features_oriented(benchmark::State& state) {
  extract_repeatedly(state, textured_image(), {.oriented = true});
}
void features_four_octaves(benchmark::State& state) {
  extract_repeatedly(state, textured_image(), {.octaves = 4});
}
void features_tracking(benchmark::State& state) {
  extract_repeatedly(state, textured_image(),
                     {.max_features = 400, .sigma_min_px = 2.4f, .sigma_max_px = 6.f}, {200, 120, 240, 240});
}
void features_1280x720(benchmark::State& state) {
  extract_repeatedly(state, textured_image({1280, 720}), {});
}
void features_1920x1080(benchmark::State& state) {
  extract_repeatedly(state, textured_image({1920, 1080}), {});
}
void features_noise(benchmark::State& state) {
  extract_repeatedly(state, noise_image(), {});
}
void features_checkerboard(benchmark::State& state) {
  extract_repeatedly(state, checkerboard_image(static_cast<int>(state.range(0))), {});
}

void opencv_orb(benchmark::State& state) {
  const cv::Mat grey = textured_image();
  const auto orb = cv::ORB::create(1000);
  std::vector<cv::KeyPoint> keypoints;
  cv::Mat descriptors;
  for (auto _ : state) orb->detectAndCompute(grey, cv::noArray(), keypoints, descriptors);
  state.SetLabel(std::to_string(keypoints.size()) + " features");
}

void stage_integral(benchmark::State& state) {
  const cv::Mat grey = textured_image();
  IntegralImage integral(grey.cols, grey.rows);
  for (auto _ : state) integral.compute(view_of(grey));
}

void stage_hessian(benchmark::State& state) {
  const cv::Mat grey = textured_image();
  IntegralImage integral(grey.cols, grey.rows);
  integral.compute(view_of(grey));
  FastHessian hessian(grey.cols);
  KeypointSelection selection(4000);
  const FeatureSettings settings;
  for (auto _ : state) {
    selection.start(settings.threshold);
    hessian.detect(integral, {0, 0, grey.cols, grey.rows}, settings, selection);
  }
}

void stage_descriptor(benchmark::State& state) {
  const bool upright = state.range(0) != 0;
  const cv::Mat grey = textured_image();
  IntegralImage integral(grey.cols, grey.rows);
  integral.compute(view_of(grey));
  FeatureExtractor extractor(grey.cols, grey.rows, {});
  FeatureSet features;
  extractor.extract(view_of(grey), features);
  std::size_t i = 0;
  for (auto _ : state) {
    describe(integral, features.features[i % features.features.size()], upright, features.descriptors[0]);
    ++i;
  }
}

void stage_orientation(benchmark::State& state) {
  const cv::Mat grey = textured_image();
  IntegralImage integral(grey.cols, grey.rows);
  integral.compute(view_of(grey));
  FeatureExtractor extractor(grey.cols, grey.rows, {});
  FeatureSet features;
  extractor.extract(view_of(grey), features);
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(dominant_orientation(integral, features.features[i % features.features.size()]));
    ++i;
  }
}

// 300 × 1000, the sizes of a template and a frame.
constexpr int kRefs = 300;
constexpr int kCurs = 1000;

FeatureSet strongest(int count) {
  const cv::Mat grey = textured_image();
  FeatureExtractor extractor(grey.cols, grey.rows, {.max_features = count, .threshold = 1e-6f});
  FeatureSet features;
  extractor.extract(view_of(grey), features);
  return features;
}

void match_heel(benchmark::State& state) {
  const FeatureSet ref = strongest(kRefs), cur = strongest(kCurs);
  Matcher matcher(kRefs, kCurs, {});
  std::vector<Match> matches;
  for (auto _ : state) matcher.match(ref, cur, matches);
  state.SetLabel(std::to_string(matches.size()) + " matches");
}

void match_opencv(benchmark::State& state) {
  const FeatureSet ref = strongest(kRefs), cur = strongest(kCurs);
  const auto rows = [](const FeatureSet& set) {
    cv::Mat packed(static_cast<int>(set.descriptors.size()), kDescriptorSize, CV_32F);
    for (int i = 0; i < packed.rows; ++i)
      std::copy_n(set.descriptors[static_cast<std::size_t>(i)].data(), kDescriptorSize, packed.ptr<float>(i));
    return packed;
  };
  const cv::Mat ref_rows = rows(ref), cur_rows = rows(cur);
  const cv::BFMatcher matcher(cv::NORM_L2);
  std::vector<std::vector<cv::DMatch>> matches;
  for (auto _ : state) matcher.knnMatch(ref_rows, cur_rows, matches, 2);
}

BENCHMARK(opencv_orb)->Unit(benchmark::kMillisecond);
BENCHMARK(features_upright)->Unit(benchmark::kMillisecond);
BENCHMARK(features_oriented)->Unit(benchmark::kMillisecond);
BENCHMARK(features_four_octaves)->Unit(benchmark::kMillisecond);
BENCHMARK(features_tracking)->Unit(benchmark::kMillisecond);
BENCHMARK(features_1280x720)->Unit(benchmark::kMillisecond);
BENCHMARK(features_1920x1080)->Unit(benchmark::kMillisecond);
BENCHMARK(features_noise)->Unit(benchmark::kMillisecond);
BENCHMARK(features_checkerboard)->Arg(3)->Arg(5)->Arg(7)->Arg(10)->Unit(benchmark::kMillisecond);
BENCHMARK(stage_integral)->Unit(benchmark::kMillisecond);
BENCHMARK(stage_hessian)->Unit(benchmark::kMillisecond);
BENCHMARK(stage_descriptor)->Arg(1)->Arg(0)->Unit(benchmark::kMicrosecond);
BENCHMARK(stage_orientation)->Unit(benchmark::kMicrosecond);
BENCHMARK(match_opencv)->Unit(benchmark::kMillisecond);
BENCHMARK(match_heel)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace heel::evaluation

int main(int argc, char** argv) {
  cv::setNumThreads(1);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
