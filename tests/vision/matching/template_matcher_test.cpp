// The template's matcher gives what its two methods give alone, and allocates nothing.
#include "vision/matching/template_matcher.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "support/allocation_count.h"
#include "vision/pose/scene.h"

namespace heel {
namespace {

using test::Random;

constexpr int kFeatures = 120;

void add(FeatureSet& set, std::vector<Eigen::Vector2d>& places, const Eigen::Vector2d& px,
         const Descriptor& descriptor) {
  Feature feature;
  feature.x_px = static_cast<float>(px.x());
  feature.y_px = static_cast<float>(px.y());
  feature.sigma_px = 3.f;
  feature.laplacian = 1;
  set.features.push_back(feature);
  set.descriptors.push_back(descriptor);
  places.push_back(px);
}

Descriptor random_descriptor(Random& random) {
  Eigen::Matrix<float, kDescriptorSize, 1> values;
  for (int i = 0; i < kDescriptorSize; ++i) values(i) = static_cast<float>(random.normal(1.0));
  values.normalize();
  Descriptor descriptor{};
  std::copy(values.begin(), values.end(), descriptor.begin());
  return descriptor;
}

bool same(std::span<const Match> a, std::span<const Match> b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Match& x, const Match& y) {
    return x.ref == y.ref && x.cur == y.cur && x.distance == y.distance;
  });
}

TEST(TemplateMatcher, GivesWhatEitherMethodGivesAloneAndAllocatesNothing) {
  Random random(3);
  FeatureSet ref, cur;
  std::vector<Eigen::Vector2d> ref_px, cur_px;
  std::vector<PredictedFeature> predicted;
  for (int i = 0; i < kFeatures; ++i) {
    const Eigen::Vector2d px(random.uniform(0.0, 640.0), random.uniform(0.0, 480.0));
    const Descriptor descriptor = random_descriptor(random);
    add(ref, ref_px, px, descriptor);
    add(cur, cur_px, px + random.normal2(2.0), i % 3 == 0 ? random_descriptor(random) : descriptor);
    predicted.push_back({px, 1.0});
  }
  const MatchSettings settings;
  TemplateMatcher matcher(ref, kFeatures, settings.ratio);
  FeatureGrid grid(kFeatures, GuidedMatchSettings{}.radius_px);

  std::vector<Match> everywhere, near;
  Matcher(kFeatures, kFeatures, settings).match(ref, cur, everywhere);
  grid.assign(cur, cur_px);
  GuidedMatcher(kFeatures, GuidedMatchSettings{}).match(ref, predicted, grid, near);
  ASSERT_GT(everywhere.size(), kFeatures / 2U);
  ASSERT_GT(near.size(), kFeatures / 2U);

  const std::uint64_t before = test::allocations_of_this_thread();
  EXPECT_TRUE(same(matcher.match_everywhere(cur), everywhere));
  grid.assign(cur, cur_px);
  EXPECT_TRUE(same(matcher.match_near(predicted, grid), near));
  if (test::counts_allocations()) {
    EXPECT_EQ(test::allocations_of_this_thread() - before, 0U);
  }
}

}  // namespace
}  // namespace heel
