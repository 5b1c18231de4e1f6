// The extractor on blobs of known place, size and sign, and on frames of extreme size and content.
#include <gtest/gtest.h>

#include <string>

#include "heel/error.h"
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

// The response of a box filter is largest for a Gaussian blob somewhat wider than the filter's sigma.
constexpr double kFoundSigma = 0.745;

TEST(FastHessian, FindsTheCentreScaleAndSignOfABlob) {
  for (const double sigma_px : {2.4, 2.8, 3.2, 4.0, 4.8, 5.5}) {
    for (const double amplitude : {100.0, -100.0}) {
      for (const double shift : {0.0, 0.3, 0.5, 0.8}) {
        const Blob blob{60.0 + shift, 50.0 - 0.7 * shift, sigma_px, amplitude};
        const auto image = image_of(128, 112, [&](double x, double y) { return 128.0 + blob(x, y); });
        const FeatureSet found = extract(image, {});
        SCOPED_TRACE("sigma " + std::to_string(sigma_px) + " amplitude " + std::to_string(amplitude) +
                     " shift " + std::to_string(shift));
        ASSERT_FALSE(found.features.empty());
        const Feature& feature = found.features.front();
        EXPECT_NEAR(feature.x_px, blob.x_px, 0.1);
        EXPECT_NEAR(feature.y_px, blob.y_px, 0.1);
        EXPECT_NEAR(feature.sigma_px / (kFoundSigma * sigma_px), 1.0, 0.06);
        EXPECT_EQ(feature.laplacian, amplitude < 0 ? 1 : -1);
        EXPECT_FLOAT_EQ(feature.angle_rad, 0.f);
      }
    }
  }
}

TEST(FastHessian, AcceptsFramesOfExtremeSizeAndContent) {
  FeatureSettings settings;
  settings.octaves = 4;
  settings.max_features = 200;
  settings.threshold = 1e-7f;
  settings.oriented = true;
  std::size_t described = 0;
  for (const auto& [width, height] :
       {std::pair{1, 1}, {8, 8}, {27, 27}, {28, 29}, {400, 1}, {1, 400}, {53, 300}, {333, 201}}) {
    SCOPED_TRACE(std::to_string(width) + "×" + std::to_string(height));
    EXPECT_TRUE(extract(TestImage(width, height, 0), settings).features.empty());
    EXPECT_TRUE(extract(TestImage(width, height, 255), settings).features.empty());
    for (const int period : {1, 2, 3, 5, 8}) {
      const auto checkerboard = image_of(width, height, [&](double x, double y) {
        return (static_cast<int>(x) / period + static_cast<int>(y) / period) % 2 != 0 ? 255.0 : 0.0;
      });
      EXPECT_LE(extract(checkerboard, settings).features.size(), 200U);
    }
    const FeatureSet noise = extract(noise_image(width, height, 7), settings);
    EXPECT_LE(noise.features.size(), 200U);
    for (const Descriptor& descriptor : noise.descriptors) {
      double norm2 = 0.0;
      for (const float value : descriptor) norm2 += static_cast<double>(value) * value;
      EXPECT_NEAR(norm2, 1.0, 1e-4);
    }
    described += noise.descriptors.size();
  }
  EXPECT_GT(described, 200U);
}

TEST(FastHessian, RefusesSettingsOutOfRangeAndTooLargeFrames) {
  FeatureSettings settings;
  settings.octaves = 5;
  EXPECT_THROW(FeatureExtractor(64, 64, settings), Error);
  settings.octaves = 2;
  settings.max_features = 0;
  EXPECT_THROW(FeatureExtractor(64, 64, settings), Error);
  FeatureExtractor extractor(64, 64, {});
  FeatureSet features;
  EXPECT_THROW(extractor.extract(TestImage(65, 64).view(), features), Error);
}

/// Of the region, by an extractor that has seen another picture before.
FeatureSet extract_after_another(const TestImage& image, const FeatureSettings& settings,
                                 const Region& region) {
  FeatureExtractor extractor(image.width_px, image.height_px, settings);
  FeatureSet features;
  extractor.extract(noise_image(image.width_px, image.height_px, 8).view(), features);
  extractor.extract(image.view(), region, features);
  return features;
}

void expect_the_same_in(const Region& region, const TestImage& image, const FeatureSettings& settings) {
  const FeatureSet all = extract(image, settings);
  const FeatureSet inside = extract_after_another(image, settings, region);
  std::size_t expected = 0;
  for (std::size_t i = 0; i < all.features.size(); ++i) {
    const Feature& feature = all.features[i];
    const double x = feature.x_px + 0.5 - region.x_px, y = feature.y_px + 0.5 - region.y_px;
    if (x < 0 || y < 0 || x >= region.width_px || y >= region.height_px) continue;
    ASSERT_LT(expected, inside.features.size());
    EXPECT_EQ(inside.features[expected].x_px, feature.x_px);
    EXPECT_EQ(inside.features[expected].response, feature.response);
    EXPECT_EQ(inside.features[expected].angle_rad, feature.angle_rad);
    for (std::size_t k = 0; k < kDescriptorSize; ++k) {
      // The rounding of a rotated descriptor depends on where the integral image begins.
      const float tolerance = settings.oriented ? 1e-5f : 0.f;
      EXPECT_NEAR(inside.descriptors[expected][k], all.descriptors[i][k], tolerance);
    }
    ++expected;
  }
  EXPECT_GT(expected, 5U);
  EXPECT_EQ(inside.features.size(), expected);
}

TEST(FastHessian, SearchesOnlyTheRegionAndFindsTheSameThere) {
  const BlobField field(320, 240, 300, 3);
  const auto image = image_of(320, 240, field);
  FeatureSettings settings;
  settings.spread = false;
  for (const bool oriented : {false, true}) {
    settings.oriented = oriented;
    for (const int octaves : {1, 2, 3}) {
      settings.octaves = octaves;
      for (const Region& region : {Region{101, 57, 90, 83}, Region{0, 0, 100, 90}, Region{215, 150, 105, 90}})
        expect_the_same_in(region, image, settings);
    }
    settings.sigma_max_px = 2.5f;
    expect_the_same_in({101, 57, 90, 83}, image, settings);
    settings.sigma_max_px = 1e9f;
  }
}

TEST(FastHessian, KeepsToTheScaleRange) {
  const auto image = image_of(320, 240, BlobField(320, 240, 150, 5));
  FeatureSettings settings;
  settings.octaves = 3;
  settings.spread = false;
  const FeatureSet all = extract(image, settings);
  settings.sigma_min_px = 2.2f;
  settings.sigma_max_px = 3.9f;
  const FeatureSet bounded = extract(image, settings);
  std::size_t expected = 0;
  for (const Feature& feature : all.features) {
    if (feature.sigma_px < 2.2f || feature.sigma_px > 3.9f) continue;
    ASSERT_LT(expected, bounded.features.size());
    EXPECT_EQ(bounded.features[expected].sigma_px, feature.sigma_px);
    ++expected;
  }
  EXPECT_GT(expected, 5U);
  EXPECT_LT(expected, all.features.size());
  EXPECT_EQ(bounded.features.size(), expected);
}

}  // namespace
}  // namespace heel
