// A part of the frame, enlarged by two and searched.
#include "vision/features/upsampled_region.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "heel/features.h"
#include "vision/features/extracted.h"
#include "vision/features/test_image.h"

namespace heel {
namespace {

using test::Blob;
using test::BlobField;
using test::extract;
using test::image_of;
using test::noise_image;
using test::TestImage;

/// The grey level at any place of `part`, bilinear; beyond the edge that of the edge.
double level_at(const TestImage& image, const Region& part, double x, double y) {
  const auto at = [&](double column, double row) {
    return static_cast<double>(
        image.at(std::clamp(static_cast<int>(column), part.x_px, part.x_px + part.width_px - 1),
                 std::clamp(static_cast<int>(row), part.y_px, part.y_px + part.height_px - 1)));
  };
  const double left = std::floor(x), top = std::floor(y), u = x - left, v = y - top;
  return (1 - v) * ((1 - u) * at(left, top) + u * at(left + 1, top)) +
         v * ((1 - u) * at(left, top + 1) + u * at(left + 1, top + 1));
}

TEST(UpsampledRegion, IsTheBilinearEnlargementOfItsPart) {
  const TestImage image = noise_image(90, 70, 3);
  UpsampledRegion enlarged(90, 90 * 70);
  for (const Region& part :
       {Region{0, 0, 45, 35}, Region{45, 35, 45, 35}, Region{30, 0, 22, 70}, Region{20, 11, 1, 7}}) {
    const FrameView view = enlarged.upsample(image.view(), part);
    ASSERT_EQ(view.header.width_px, static_cast<std::uint32_t>(2 * part.width_px));
    ASSERT_EQ(view.header.height_px, static_cast<std::uint32_t>(2 * part.height_px));
    for (int y = 0; y < 2 * part.height_px; ++y)
      for (int x = 0; x < 2 * part.width_px; ++x)
        ASSERT_NEAR(view.grey[static_cast<std::size_t>(y) * view.stride_bytes + static_cast<std::size_t>(x)],
                    level_at(image, part, enlarged.x_in_frame(static_cast<float>(x)),
                             enlarged.y_in_frame(static_cast<float>(y))),
                    0.5001)
            << x << ", " << y;
  }
}

TEST(UpsampledRegion, HasRoomForAQuarterOfTheFramesArea) {
  const UpsampledRegion enlarged(90, 90 * 70);
  EXPECT_TRUE(enlarged.has_room_for({5, 5, 45, 35}));
  EXPECT_TRUE(enlarged.has_room_for({0, 0, 22, 70}));
  EXPECT_FALSE(enlarged.has_room_for({0, 0, 46, 10}));
  EXPECT_FALSE(enlarged.has_room_for({0, 0, 45, 36}));
  EXPECT_FALSE(enlarged.has_room_for({0, 0, 23, 70}));
}

TEST(UpsampledFeatures, FindsABlobTooSmallForTheSmallestFilter) {
  const Blob blob{61.3, 48.8, 1.3, 120.0};
  const auto image = image_of(240, 200, [&](double x, double y) { return 128.0 + blob(x, y); });
  const Region region{40, 30, 45, 40};
  FeatureSettings settings;
  EXPECT_TRUE(extract(image, settings, region).features.empty());
  settings.upsample = true;
  const FeatureSet found = extract(image, settings, region);
  ASSERT_FALSE(found.features.empty());
  const Feature& feature = found.features.front();
  EXPECT_NEAR(feature.x_px, blob.x_px, 0.15);
  EXPECT_NEAR(feature.y_px, blob.y_px, 0.15);
  EXPECT_GT(feature.sigma_px, 0.8f);
  EXPECT_LT(feature.sigma_px, 1.6f);
}

// The same scene from twice the distance, upsampled: mostly the same features at half the size, with
// descriptors similar enough to be matched.
TEST(UpsampledFeatures, AreThoseOfTheSceneAtTwiceTheSize) {
  const BlobField field(240, 200, 400, 5);
  const TestImage whole = image_of(240, 200, field);
  const auto far = image_of(240, 200, [&](double x, double y) {  // each pixel covers four of the larger image
    double sum = 0.0;
    for (const double dy : {-0.5, 0.5})
      for (const double dx : {-0.5, 0.5}) sum += 0.25 * field(2.0 * x + 0.5 + dx, 2.0 * y + 0.5 + dy);
    return sum;
  });
  FeatureSettings settings;
  settings.max_features = 150;
  const FeatureSet near_features = extract(whole, settings, {40, 40, 140, 100});
  settings.upsample = true;
  const FeatureSet far_features = extract(far, settings, {20, 20, 70, 50});
  int again = 0;
  for (std::size_t i = 0; i < near_features.features.size(); ++i) {
    const Feature& a = near_features.features[i];
    for (std::size_t k = 0; k < far_features.features.size(); ++k) {
      const Feature& b = far_features.features[k];
      double distance2 = 0.0;
      for (std::size_t n = 0; n < near_features.descriptors[i].size(); ++n)
        distance2 += std::pow(near_features.descriptors[i][n] - far_features.descriptors[k][n], 2);
      if (std::hypot(2.f * b.x_px + 0.5f - a.x_px, 2.f * b.y_px + 0.5f - a.y_px) < 1.5f &&
          std::abs(std::log2(2.f * b.sigma_px / a.sigma_px)) < 0.3f && distance2 < 0.2 * 0.2) {
        ++again;
        break;
      }
    }
  }
  EXPECT_GE(again, static_cast<int>(0.7 * static_cast<double>(near_features.features.size())))
      << "of " << near_features.features.size();
}

TEST(UpsampledFeatures, ARegionTooLargeToUpsampleIsSearchedAsItIs) {
  const TestImage image = image_of(160, 120, BlobField(160, 120, 150, 8));
  FeatureSettings settings;
  const FeatureSet plain = extract(image, settings, {10, 10, 120, 90});
  settings.upsample = true;
  const FeatureSet upsample = extract(image, settings, {10, 10, 120, 90});
  ASSERT_EQ(upsample.features.size(), plain.features.size());
  EXPECT_EQ(upsample.descriptors, plain.descriptors);
}

// A region of the shape of a torso: upsampled it is twice as tall as the frame.
TEST(UpsampledFeatures, AreTheSameInATallRegionAndInItsParts) {
  const TestImage image = image_of(240, 200, BlobField(240, 200, 600, 12));
  FeatureSettings settings;
  settings.upsample = true;
  settings.sigma_max_px = 2.f;
  const auto inner = [](const FeatureSet& set, int top, int bottom) {
    std::vector<std::pair<float, float>> at_px;
    for (const Feature& feature : set.features)
      if (feature.y_px >= static_cast<float>(top) && feature.y_px < static_cast<float>(bottom))
        at_px.emplace_back(feature.x_px, feature.y_px);
    std::sort(at_px.begin(), at_px.end());
    return at_px;
  };
  const FeatureSet tall = extract(image, settings, {60, 10, 20, 180});
  for (const Region& part : {Region{60, 10, 20, 90}, Region{60, 100, 20, 90}}) {
    const int top = part.y_px + 5, bottom = part.y_px + part.height_px - 5;
    const auto expected = inner(extract(image, settings, part), top, bottom);
    ASSERT_GE(expected.size(), 5U);
    const auto found = inner(tall, top, bottom);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
      EXPECT_NEAR(found[i].first, expected[i].first, 1e-3f);
      EXPECT_NEAR(found[i].second, expected[i].second, 1e-3f);
    }
  }
}

TEST(UpsampledFeatures, LieInTheRequestedRegionAndScales) {
  const TestImage image = image_of(240, 200, BlobField(240, 200, 600, 9));
  for (const Region& region : {Region{-20, -20, 70, 60}, Region{190, 160, 80, 80}, Region{50, 40, 50, 30}}) {
    FeatureSettings settings;
    settings.upsample = true;
    settings.sigma_min_px = 1.2f;
    settings.sigma_max_px = 2.f;
    const FeatureSet found = extract(image, settings, region);
    ASSERT_FALSE(found.features.empty());
    EXPECT_TRUE(std::any_of(found.features.begin(), found.features.end(), [](const Feature& feature) {
      return feature.sigma_px < 1.6f;
    })) << "smaller than the smallest filter finds";
    for (const Feature& feature : found.features) {
      EXPECT_GE(feature.sigma_px, 1.2f);
      EXPECT_LE(feature.sigma_px, 2.f);
      EXPECT_GE(feature.x_px, static_cast<float>(std::max(0, region.x_px)) - 0.5f);
      EXPECT_GE(feature.y_px, static_cast<float>(std::max(0, region.y_px)) - 0.5f);
      EXPECT_LE(feature.x_px, static_cast<float>(std::min(240, region.x_px + region.width_px)) - 0.5f);
      EXPECT_LE(feature.y_px, static_cast<float>(std::min(200, region.y_px + region.height_px)) - 0.5f);
    }
  }
}

}  // namespace
}  // namespace heel
