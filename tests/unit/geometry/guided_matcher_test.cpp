#include "vision/guided_matcher.h"

#include <gtest/gtest.h>

#include "allocation_count.h"
#include "scene.h"
#include "vision/shape_plausibility.h"

namespace {

using heel::Descriptor;
using heel::Feature;
using heel::FeatureSet;
using heel::GuidedMatcher;
using heel::GuidedMatchSettings;
using heel::Match;
using heel::PredictedView;

/// A descriptor about `apart` away from the one with the same first direction.
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
  std::vector<PredictedView> predicted() const {
    std::vector<PredictedView> views;
    for (const Eigen::Vector2d& px : ref_px)
      views.push_back({heel_test::mapped(H, px), heel::local_scale(H, px)});
    return views;
  }
  std::vector<Match> match() const {
    GuidedMatcher matcher(100, GuidedMatchSettings{});
    std::vector<Match> out;
    matcher.look_at(cur, cur_px);
    matcher.match(predicted(), ref, out);
    return out;
  }
};

TEST(GuidedMatcher, TakesTheNearestDescriptorWhereThePointShouldBe) {
  Scene scene;
  scene.add_ref(50, 40, 2.f, descriptor(0));
  scene.add_cur(300, 80, 4.f, descriptor(0));        // identical, elsewhere
  scene.add_cur(103, 82, 4.f, descriptor(0, 0.3f));  // here
  scene.add_cur(98, 79, 4.f, descriptor(1));         // here, but another thing
  const std::vector<Match> matches = scene.match();
  ASSERT_EQ(matches.size(), 1u);
  EXPECT_EQ(matches[0].ref, 0);
  EXPECT_EQ(matches[0].cur, 1);
  EXPECT_NEAR(matches[0].distance, 0.3f, 0.02f);
}

TEST(GuidedMatcher, RefusesWrongSignScalePlaceAndLooks) {
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

TEST(GuidedMatcher, RefusesTwoThatLookAlikeWithinTheRadius) {
  Scene scene;
  scene.add_ref(50, 40, 2.f, descriptor(0));
  scene.add_cur(101, 80, 4.f, descriptor(0, 0.30f));
  scene.add_cur(97, 81, 4.f, descriptor(0, 0.31f));
  EXPECT_TRUE(scene.match().empty());
}

TEST(GuidedMatcher, AFrameFeatureIsGivenToTheNearestTemplateFeatureOnly) {
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
  heel_test::Random random(5);
  Scene scene;
  scene.H = heel_test::random_view(random, heel_test::plain_camera()).H;
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector2d ref(random.uniform(220, 420), random.uniform(90, 390));
    const Eigen::Vector2d cur = heel_test::mapped(scene.H, ref) + random.normal2(3.0);
    const auto direction = static_cast<std::size_t>(random.uniform(0, 60));
    scene.add_ref(ref.x(), ref.y(), 3.f, descriptor(direction));
    scene.add_cur(cur.x(), cur.y(), static_cast<float>(random.uniform(2.0, 4.5)),
                  descriptor(direction, 0.2f));
  }
  GuidedMatcher matcher(200, GuidedMatchSettings{});
  std::vector<Match> out;
  out.reserve(200);
  const std::vector<PredictedView> views = scene.predicted();
  const std::uint64_t before = heel::test::allocations_of_this_thread();
  matcher.look_at(scene.cur, scene.cur_px);
  matcher.match(views, scene.ref, out);
  if (heel::test::counts_allocations()) {
    EXPECT_EQ(heel::test::allocations_of_this_thread() - before, 0u);
  }
  EXPECT_GT(out.size(), 50u);
  for (const Match& match : out) {
    const Eigen::Vector2d predicted =
        heel_test::mapped(scene.H, scene.ref_px[static_cast<std::size_t>(match.ref)]);
    EXPECT_LT((predicted - scene.cur_px[static_cast<std::size_t>(match.cur)]).norm(), 8.0);
  }
}

}  // namespace
