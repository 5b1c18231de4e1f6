// The matcher against a plain exhaustive search in double precision.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "heel/matching.h"
#include "support/each_simd_target.h"

namespace heel {
namespace {

FeatureSet random_features(int count, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  FeatureSet set;
  for (int i = 0; i < count; ++i) {
    Descriptor descriptor;
    double norm2 = 0.0;
    for (float& value : descriptor) {
      value = static_cast<float>(normal(random));
      norm2 += static_cast<double>(value) * value;
    }
    for (float& value : descriptor) value /= static_cast<float>(std::sqrt(norm2));
    Feature feature;
    feature.laplacian = random() % 3 == 0 ? std::int8_t{1} : std::int8_t{-1};
    set.features.push_back(feature);
    set.descriptors.push_back(descriptor);
  }
  return set;
}

/// Some of `ref`, shuffled and with noise, among unrelated features.
FeatureSet disturbed(const FeatureSet& ref, int strangers, double disturbance, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, disturbance / 8.0);
  FeatureSet cur = random_features(strangers, seed + 1);
  for (std::size_t i = ref.features.size(); i-- > 0;) {
    Descriptor descriptor = ref.descriptors[i];
    double norm2 = 0.0;
    for (float& value : descriptor) {
      value += static_cast<float>(normal(random));
      norm2 += static_cast<double>(value) * value;
    }
    for (float& value : descriptor) value /= static_cast<float>(std::sqrt(norm2));
    cur.features.push_back(ref.features[i]);
    cur.descriptors.push_back(descriptor);
  }
  return cur;
}

double distance(const Descriptor& a, const Descriptor& b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += (double(a[k]) - b[k]) * (double(a[k]) - b[k]);
  return std::sqrt(sum);
}

struct PlainNearest {
  int index = -1;
  double best = std::numeric_limits<double>::infinity();
  double second = std::numeric_limits<double>::infinity();
};

PlainNearest plain_nearest(const FeatureSet& from, std::size_t i, const FeatureSet& to) {
  PlainNearest nearest;
  for (std::size_t j = 0; j < to.features.size(); ++j) {
    if (to.features[j].laplacian != from.features[i].laplacian) continue;
    const double d = distance(from.descriptors[i], to.descriptors[j]);
    if (d < nearest.best) {
      nearest.second = nearest.best;
      nearest.best = d;
      nearest.index = static_cast<int>(j);
    } else if (d < nearest.second) {
      nearest.second = d;
    }
  }
  return nearest;
}

std::vector<Match> plain_match(const FeatureSet& ref, const FeatureSet& cur, const MatchSettings& settings) {
  std::vector<Match> matches;
  for (std::size_t i = 0; i < ref.features.size(); ++i) {
    const PlainNearest nearest = plain_nearest(ref, i, cur);
    if (nearest.index < 0 || !(nearest.best < static_cast<double>(settings.ratio) * nearest.second)) continue;
    if (settings.mutual &&
        plain_nearest(cur, static_cast<std::size_t>(nearest.index), ref).index != static_cast<int>(i))
      continue;
    matches.push_back({static_cast<std::int32_t>(i), nearest.index, static_cast<float>(nearest.best)});
  }
  return matches;
}

TEST(Matcher, AgreesWithExhaustiveSearch) {
  for (const bool mutual : {false, true}) {
    for (const auto& [refs, strangers] :
         {std::pair{0, 10}, {1, 0}, {1, 1}, {3, 5}, {7, 31}, {64, 64}, {301, 700}, {5, 1000}}) {
      SCOPED_TRACE(std::to_string(refs) + " among " + std::to_string(strangers));
      const FeatureSet ref = random_features(refs, 11);
      const FeatureSet cur = disturbed(ref, strangers, 0.6, 12);
      const MatchSettings settings{.ratio = 0.8f, .mutual = mutual};
      Matcher matcher(refs, refs + strangers, settings);
      std::vector<Match> matches;
      matcher.match(ref, cur, matches);
      const std::vector<Match> expected = plain_match(ref, cur, settings);
      ASSERT_EQ(matches.size(), expected.size());
      for (std::size_t i = 0; i < matches.size(); ++i) {
        EXPECT_EQ(matches[i].ref, expected[i].ref);
        EXPECT_EQ(matches[i].cur, expected[i].cur);
        EXPECT_NEAR(matches[i].distance, expected[i].distance, 1e-4f);
      }
    }
  }
}

void expect_the_plain_matches(const FeatureSet& ref, const FeatureSet& cur, const MatchSettings& settings) {
  const std::vector<Match> expected = plain_match(ref, cur, settings);
  test::for_each_simd_target([&] {
    Matcher matcher(static_cast<int>(ref.features.size()), static_cast<int>(cur.features.size()), settings);
    std::vector<Match> matches;
    matcher.match(ref, cur, matches);
    ASSERT_EQ(matches.size(), expected.size());
    for (std::size_t i = 0; i < matches.size(); ++i) {
      ASSERT_EQ(matches[i].ref, expected[i].ref);
      ASSERT_EQ(matches[i].cur, expected[i].cur);
    }
  });
}

// Descriptors so close together that bytes do not decide and floats must: from nearly equal to clearly
// different.
TEST(Matcher, IsExactWhereBytesDoNotDecide) {
  for (const double apart : {0.01, 0.03, 0.1, 0.3}) {
    for (const float ratio : {0.8f, 0.97f, 2.f}) {
      SCOPED_TRACE(std::to_string(apart) + " apart, ratio " + std::to_string(ratio));
      FeatureSet one = random_features(1, 31);
      FeatureSet ref = one, cur;
      for (int i = 1; i < 60; ++i) {
        ref.features.push_back(one.features[0]);
        ref.descriptors.push_back(one.descriptors[0]);
      }
      ref = disturbed(ref, 0, apart, 32);
      cur = disturbed(ref, 0, ratio > 1.f ? apart : apart / 3.0, 33);
      expect_the_plain_matches(ref, cur, {.ratio = ratio});
      EXPECT_FALSE(plain_match(ref, cur, {.ratio = 0.97f}).empty());
    }
  }
}

// Elements outside the range of bytes, opposite descriptors, whose byte product is the smallest possible, and
// one descriptor for all features.
TEST(Matcher, IsExactForExtremeDescriptors) {
  const auto of = [](std::size_t k, float value) {
    Descriptor descriptor{};
    descriptor[k] = value;
    return descriptor;
  };
  FeatureSet ref, cur;
  const auto add = [](FeatureSet& set, const Descriptor& descriptor) {
    set.features.emplace_back();
    set.features.back().laplacian = 1;
    set.descriptors.push_back(descriptor);
  };
  for (std::size_t k = 0; k < 20; ++k) {
    add(ref, of(k, 1.f));
    add(cur, of(k, k % 2 == 0 ? 1.f : -1.f));
  }
  Descriptor dense;
  for (std::size_t k = 0; k < dense.size(); ++k) dense[k] = k % 2 == 0 ? 0.125f : -0.125f;
  Descriptor opposite = dense;
  for (float& value : opposite) value = -value;
  add(ref, dense);
  add(cur, opposite);
  expect_the_plain_matches(ref, cur, {});
  add(cur, dense);
  expect_the_plain_matches(ref, cur, {});
  EXPECT_GT(plain_match(ref, cur, {}).size(), 10U);

  FeatureSet same;
  for (int i = 0; i < 70; ++i) add(same, dense);
  expect_the_plain_matches(same, same, {});
}

TEST(Matcher, NeverPairsOppositeSigns) {
  FeatureSet ref = random_features(40, 21);
  FeatureSet cur = ref;
  for (Feature& feature : cur.features) feature.laplacian = static_cast<std::int8_t>(-feature.laplacian);
  Matcher matcher(40, 40,
                  {.ratio = 2.f, .mutual = false});  // the nearest counts, however alike the second is
  std::vector<Match> matches;
  matcher.match(ref, cur, matches);
  EXPECT_EQ(matches.size(), 40U);
  for (const Match& match : matches) {
    EXPECT_EQ(ref.features[static_cast<std::size_t>(match.ref)].laplacian,
              cur.features[static_cast<std::size_t>(match.cur)].laplacian);
    EXPECT_NE(match.ref, match.cur);
  }
  matcher.match(ref, ref, matches);
  EXPECT_EQ(matches.size(), 40U);
}

}  // namespace
}  // namespace heel
