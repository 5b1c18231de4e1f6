#include "vision/matching/guided_matcher.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "support/allocation_count.h"
#include "vision/homography/shape_plausibility.h"
#include "vision/pose/scene.h"

namespace heel {
namespace {

/// A descriptor at a distance of about `apart` from descriptor(direction).
Descriptor descriptor(std::size_t direction, float apart = 0.f) {
  Descriptor d{};
  d[direction] = std::sqrt(1.f - apart * apart);
  d[63] = apart;
  return d;
}

struct Scene {
  FeatureSet ref, cur;
  std::vector<Eigen::Vector2d> ref_px, cur_px;
  Eigen::Matrix3d H = Eigen::DiagonalMatrix<double, 3>(2.0, 2.0, 1.0);

  static void add(FeatureSet& set, std::vector<Eigen::Vector2d>& points, double x, double y, float sigma,
                  const Descriptor& what, int laplacian) {
    Feature feature;
    feature.x_px = static_cast<float>(x);
    feature.y_px = static_cast<float>(y);
    feature.sigma_px = sigma;
    feature.laplacian = static_cast<std::int8_t>(laplacian);
    set.features.push_back(feature);
    set.descriptors.push_back(what);
    points.emplace_back(x, y);
  }
  void add_ref(double x, double y, float sigma, const Descriptor& what, int laplacian = 1) {
    add(ref, ref_px, x, y, sigma, what, laplacian);
  }
  void add_cur(double x, double y, float sigma, const Descriptor& what, int laplacian = 1) {
    add(cur, cur_px, x, y, sigma, what, laplacian);
  }
  std::vector<PredictedFeature> predicted() const {
    std::vector<PredictedFeature> views;
    for (const Eigen::Vector2d& px : ref_px) views.push_back({test::mapped(H, px), local_scale(H, px)});
    return views;
  }
  std::vector<Match> match() const {
    GuidedMatcher matcher(100, GuidedMatchSettings{});
    FeatureGrid grid(100, GuidedMatchSettings{}.radius_px);
    std::vector<Match> out;
    grid.assign(cur, cur_px);
    matcher.match(ref, predicted(), grid, out);
    return out;
  }
};

using IndexPairs = std::vector<std::pair<int, int>>;

IndexPairs as_pairs(const std::vector<Match>& matches) {
  IndexPairs pairs;
  for (const Match& match : matches) pairs.emplace_back(match.ref, match.cur);
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

/// The same rules by trying every pair.
std::vector<Match> by_trying_every_pair(const Scene& scene, const std::vector<PredictedFeature>& views) {
  const GuidedMatchSettings rules;
  std::map<int, Match> of_frame_feature;
  for (std::size_t r = 0; r < views.size(); ++r) {
    std::vector<std::pair<float, int>> near;
    for (std::size_t c = 0; c < scene.cur_px.size(); ++c) {
      const double sigma = scene.ref.features[r].sigma_px * views[r].scale;
      const double ratio = scene.cur.features[c].sigma_px / sigma;
      if (!((scene.cur_px[c] - views[r].px).norm() < rules.radius_px)) continue;
      if (!(ratio >= 1.0 / rules.scale_ratio && ratio <= rules.scale_ratio)) continue;
      if (scene.cur.features[c].laplacian != scene.ref.features[r].laplacian) continue;
      float squared = 0.f;
      for (std::size_t i = 0; i < kDescriptorSize; ++i)
        squared += std::pow(scene.ref.descriptors[r][i] - scene.cur.descriptors[c][i], 2.f);
      near.emplace_back(std::sqrt(squared), static_cast<int>(c));
    }
    std::sort(near.begin(), near.end());
    if (near.empty() || near[0].first >= rules.max_distance) continue;
    if (near.size() > 1 && near[0].first > rules.ratio * near[1].first) continue;
    const Match match{static_cast<std::int32_t>(r), near[0].second, near[0].first};
    const auto [taken, first] = of_frame_feature.emplace(match.cur, match);
    if (!first && match.distance < taken->second.distance) taken->second = match;
  }
  std::vector<Match> matches;
  for (const auto& [cur, match] : of_frame_feature) matches.push_back(match);
  return matches;
}

TEST(GuidedMatcher, TakesTheNearestDescriptorWithinTheRadius) {
  Scene scene;
  scene.add_ref(50, 40, 2.f, descriptor(0));
  scene.add_cur(300, 80, 4.f, descriptor(0));        // identical, outside the radius
  scene.add_cur(103, 82, 4.f, descriptor(0, 0.3f));  // inside
  scene.add_cur(98, 79, 4.f, descriptor(1));         // inside, but another descriptor
  const std::vector<Match> matches = scene.match();
  ASSERT_EQ(matches.size(), 1u);
  EXPECT_EQ(matches[0].ref, 0);
  EXPECT_EQ(matches[0].cur, 1);
  EXPECT_NEAR(matches[0].distance, 0.3f, 0.02f);
}

TEST(GuidedMatcher, RefusesWrongSignScalePlaceAndDescriptor) {
  const auto one_candidate = [](double x, float sigma, const Descriptor& what, int laplacian) {
    Scene scene;
    scene.add_ref(50, 40, 2.f, descriptor(0));
    scene.add_cur(x, 80, sigma, what, laplacian);
    return scene.match().size();
  };
  EXPECT_EQ(one_candidate(100, 4.f, descriptor(0), 1), 1u);
  EXPECT_EQ(one_candidate(100, 4.f, descriptor(0), -1), 0u);
  EXPECT_EQ(one_candidate(100, 5.9f, descriptor(0), 1), 1u);
  EXPECT_EQ(one_candidate(100, 6.1f, descriptor(0), 1), 0u);
  EXPECT_EQ(one_candidate(100, 2.6f, descriptor(0), 1), 0u);
  EXPECT_EQ(one_candidate(107.9, 4.f, descriptor(0), 1), 1u);
  EXPECT_EQ(one_candidate(108.1, 4.f, descriptor(0), 1), 0u);
  EXPECT_EQ(one_candidate(100, 4.f, descriptor(1), 1), 0u);
}

TEST(GuidedMatcher, RefusesTwoSimilarFeaturesWithinTheRadius) {
  Scene scene;
  scene.add_ref(50, 40, 2.f, descriptor(0));
  scene.add_cur(101, 80, 4.f, descriptor(0, 0.30f));
  scene.add_cur(97, 81, 4.f, descriptor(0, 0.31f));
  EXPECT_TRUE(scene.match().empty());
}

TEST(GuidedMatcher, PairsAFrameFeatureWithTheNearestTemplateFeatureOnly) {
  Scene scene;
  scene.add_ref(50, 40, 2.f, descriptor(0, 0.4f));
  scene.add_ref(51, 40, 2.f, descriptor(0, 0.1f));
  scene.add_ref(52, 40, 2.f, descriptor(0, 0.5f));
  scene.add_cur(102, 80, 4.f, descriptor(0));
  const std::vector<Match> matches = scene.match();
  ASSERT_EQ(matches.size(), 1u);
  EXPECT_EQ(matches[0].ref, 1);
}

TEST(GuidedMatcher, AgreesWithTryingEveryPairAndAllocatesNothing) {
  test::Random random(5);
  Scene scene;
  scene.H = test::random_view(random, test::plain_camera()).H;
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector2d ref(random.uniform(220, 420), random.uniform(90, 390));
    const Eigen::Vector2d cur = test::mapped(scene.H, ref) + random.normal2(3.0);
    const auto direction = static_cast<std::size_t>(random.uniform(0, 60));
    scene.add_ref(ref.x(), ref.y(), 3.f, descriptor(direction));
    scene.add_cur(cur.x(), cur.y(), static_cast<float>(random.uniform(2.0, 4.5)),
                  descriptor(direction, 0.2f));
  }
  GuidedMatcher matcher(200, GuidedMatchSettings{});
  FeatureGrid grid(200, GuidedMatchSettings{}.radius_px);
  std::vector<Match> out;
  out.reserve(200);
  const std::vector<PredictedFeature> views = scene.predicted();
  const std::uint64_t before = test::allocations_of_this_thread();
  grid.assign(scene.cur, scene.cur_px);
  matcher.match(scene.ref, views, grid, out);
  if (test::counts_allocations()) {
    EXPECT_EQ(test::allocations_of_this_thread() - before, 0u);
  }
  EXPECT_GT(out.size(), 50u);
  EXPECT_EQ(as_pairs(out), as_pairs(by_trying_every_pair(scene, views)));
}

// Undistorted features may lie far outside the view, and predictions may not be finite.
TEST(GuidedMatcher, FindsPairsFarOutsideTheView) {
  test::Random random(6);
  Scene scene;
  scene.H.setIdentity();
  for (int i = 0; i < 100; ++i) {
    const double far_px = i % 10 == 0 ? 1e7 : 300.0;
    const Eigen::Vector2d place(random.uniform(-far_px, far_px), random.uniform(-far_px, far_px));
    scene.add_ref(place.x(), place.y(), 3.f, descriptor(static_cast<std::size_t>(i % 60)));
    scene.add_cur(place.x() + 3.0, place.y() - 4.0, 3.f, descriptor(static_cast<std::size_t>(i % 60), 0.2f));
  }
  std::vector<PredictedFeature> views = scene.predicted();
  const double infinite = std::numeric_limits<double>::infinity();
  scene.cur_px[5] = {std::numeric_limits<double>::quiet_NaN(), 0.0};
  scene.cur_px[6] = {infinite, -infinite};
  scene.cur_px[7] = {1e308, -1e308};
  views[1].px = {infinite, 0.0};
  views[2].px = {0.0, std::numeric_limits<double>::quiet_NaN()};
  views[3].px = {-1e300, 1e300};
  views[4].scale = 0.0;
  GuidedMatcher matcher(100, GuidedMatchSettings{});
  FeatureGrid grid(100, GuidedMatchSettings{}.radius_px);
  std::vector<Match> out;
  grid.assign(scene.cur, scene.cur_px);
  matcher.match(scene.ref, views, grid, out);
  EXPECT_GT(out.size(), 85u);
  EXPECT_EQ(as_pairs(out), as_pairs(by_trying_every_pair(scene, views)));
}

}  // namespace
}  // namespace heel
