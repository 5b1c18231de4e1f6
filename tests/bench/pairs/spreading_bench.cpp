// Features spread over the image compared with the strongest features: matches, the part of the image that
// they cover, and the homography's corner error, on real pairs with known homographies.
//
//   build/release/bin/heel_bench_pairs [FEATURES…]      (default 200 500 1000)
#include <algorithm>
#include <cstdio>
#include <exception>
#include <set>
#include <string>
#include <vector>

#include "heel/homography.h"
#include "heel/matching.h"
#include "support/oxford_pairs.h"

namespace heel::evaluation {
namespace {

using test::OxfordPair;

constexpr double kCorrect_px = 2.5;
constexpr int kCellsAcross = 8, kCellsDown = 6;
constexpr int kSeeds = 25;  // RANSAC is random: the corner error is a distribution

struct Outcome {
  int matches = 0, correct = 0;
  int cells = 0;  // of 8 × 6, with a correct match
  double median_corner_px = 0.0, worst_corner_px = 0.0;
};

FeatureSet features_of(const cv::Mat& grey, const FeatureSettings& settings) {
  FeatureSet features;
  FeatureExtractor(grey.cols, grey.rows, settings).extract(test::view_of(grey), features);
  return features;
}

Outcome measure(const OxfordPair& pair, const FeatureSettings& settings) {
  const FeatureSet ref = features_of(pair.reference, settings), cur = features_of(pair.current, settings);
  Matcher matcher(settings.max_features, settings.max_features, {});
  std::vector<Match> matches;
  matcher.match(ref, cur, matches);

  Outcome outcome;
  std::vector<PointPair> pairs;
  std::set<int> cells;
  for (const Match& match : matches) {
    const Feature& a = ref.features[static_cast<std::size_t>(match.ref)];
    const Feature& b = cur.features[static_cast<std::size_t>(match.cur)];
    pairs.push_back({{a.x_px, a.y_px}, {b.x_px, b.y_px}});
    const Eigen::Vector2d expected_px =
        (pair.H_cur_from_ref * pairs.back().ref_px.homogeneous()).hnormalized();
    if ((expected_px - pairs.back().cur_px).norm() >= kCorrect_px) continue;
    ++outcome.correct;
    const int column = static_cast<int>(a.x_px * kCellsAcross / static_cast<float>(pair.reference.cols));
    const int row = static_cast<int>(a.y_px * kCellsDown / static_cast<float>(pair.reference.rows));
    cells.insert(row * kCellsAcross + column);
  }
  outcome.matches = static_cast<int>(matches.size());
  outcome.cells = static_cast<int>(cells.size());

  std::vector<double> errors_px;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    HomographyEstimator estimator(settings.max_features, {.seed = static_cast<std::uint64_t>(seed)});
    std::vector<std::uint8_t> mask;
    const RobustHomography found = estimator.estimate(pairs, mask);
    errors_px.push_back(found.status == HomographyStatus::Ok
                            ? test::mean_corner_error_px(pair, found.H_cur_from_ref)
                            : std::numeric_limits<double>::infinity());
  }
  std::sort(errors_px.begin(), errors_px.end());
  outcome.median_corner_px = errors_px[kSeeds / 2];
  outcome.worst_corner_px = errors_px.back();
  return outcome;
}

void print(const Outcome& outcome) {
  std::printf("  %5d %5d %5d %8.2f %8.2f", outcome.matches, outcome.correct, outcome.cells,
              outcome.median_corner_px, outcome.worst_corner_px);
}

int run(const std::vector<int>& budgets) {
  std::printf("%-12s %8s  | %-35s | %s\n", "pair", "features", "spread", "strongest only");
  std::printf("%-12s %8s", "", "");
  for (int half = 0; half < 2; ++half) std::printf("  | match  corr cells   median    worst");
  std::printf("  (corner error, px, %d seeds)\n", kSeeds);
  bool any = false;
  for (const char* set : {"graf", "boat", "leuven"}) {
    if (!test::has_data(test::oxford_folder(set))) continue;
    any = true;
    for (int to = 2; to <= 6; ++to) {
      const OxfordPair pair = test::load_oxford_pair(set, to);
      for (const int budget : budgets) {
        FeatureSettings settings{
            .octaves = 3, .max_features = budget, .oriented = std::string(set) == "boat"};
        std::printf("%-12s %8d  |", pair.name().c_str(), budget);
        settings.spread = true;
        print(measure(pair, settings));
        settings.spread = false;
        std::printf("  |");
        print(measure(pair, settings));
        std::printf("\n");
      }
    }
  }
  if (!any) std::printf("no test data at %s: nothing measured\n", test::data_path().c_str());
  return 0;
}

}  // namespace
}  // namespace heel::evaluation

int main(int argc, char** argv) {
  std::vector<int> budgets;
  for (int i = 1; i < argc; ++i) {
    budgets.push_back(std::atoi(argv[i]));
    if (budgets.back() < 10) {
      std::fprintf(stderr, "heel_bench_pairs: '%s' is not a number of features (expected 10 or more)\n",
                   argv[i]);
      return 2;
    }
  }
  if (budgets.empty()) budgets = {200, 500, 1000};
  try {
    return heel::evaluation::run(budgets);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "heel_bench_pairs: %s\n", error.what());
    return 2;
  }
}
