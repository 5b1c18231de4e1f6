// The fast path held to the plain one (reference_surf.h), stage by stage, and to itself on every instruction
// set.
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cmath>
#include <numbers>
#include <string>

#include "heel/features.h"
#include "heel/matching.h"
#include "reference_surf.h"
#include "vision/descriptor.h"
#include "vision/hessian_rows.h"
#include "vision/integral_image.h"
#include "vision/orientation.h"

namespace heel::test {
namespace {

TestImage textured(int width, int height, unsigned seed) {
  const BlobField field(width, height, width * height / 250, seed);
  return image_of(width, height, field);
}

IntegralImage integral_of(const TestImage& image) {
  IntegralImage integral(image.width_px, image.height_px);
  integral.compute(image.view());
  return integral;
}

double angle_between(double a, double b) {
  return std::abs(std::remainder(a - b, 2 * std::numbers::pi));
}

/// Runs `body` once for each instruction set this processor has, alone.
template <typename Body>
void for_each_target(Body body) {
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(target);
    body();
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

TEST(FeaturesReference, IntegralImageIsTheSumOfPixels) {
  for (const auto& [width, height] : {std::pair{1, 1}, {15, 3}, {16, 16}, {17, 5}, {64, 2}, {131, 37}}) {
    const TestImage image = noise_image(width, height, 1);
    const IntegralImage integral = integral_of(image);
    for (int y = 0; y <= height; ++y) {
      for (int x = 0; x <= width; ++x)
        ASSERT_EQ(integral.row(y)[x], static_cast<std::uint32_t>(box_sum(image, 0, 0, x, y)));
    }
  }
}

TEST(FeaturesReference, HessianRowsEqualThePaperToSixDigits) {
  const TestImage image = noise_image(211, 203, 2);
  const IntegralImage integral = integral_of(image);
  HessianRowWork work(image.width_px);
  std::vector<float> response(static_cast<std::size_t>(image.width_px + kResponsePadding));
  for (const int lobe : {3, 5, 7, 9, 13, 17, 25, 33, 49, 65}) {
    const BoxFilter filter{lobe};
    for (const int step : {1, 2, 4, 8}) {
      const int y = 101;
      const int first = (filter.half() + step - 1) / step;
      const int last = (image.width_px - 1 - filter.half()) / step + 1;
      hessian_response_row(integral, filter, y, step, first, last, work, response.data());
      // The determinant is a difference of products: the bound is relative to their size, not to the result.
      for (int i = first; i < last; ++i) {
        const ReferenceHessian expected = reference_hessian(image, i * step, y, filter.side());
        ASSERT_NEAR(response[static_cast<std::size_t>(i)], expected.determinant,
                    1e-6 * (expected.trace * expected.trace + std::abs(expected.determinant) + 1e-3))
            << "side " << filter.side() << " step " << step << " sample " << i;
        ASSERT_EQ(laplacian_sign(integral, filter, i * step, y), expected.trace >= 0 ? 1 : -1);
      }
    }
  }
}

TEST(FeaturesReference, DescriptorsEqualThePlainOnes) {
  const TestImage image = textured(160, 120, 3);
  const IntegralImage integral = integral_of(image);
  for (const auto& [x, y, sigma] : {std::tuple{80.3f, 61.7f, 1.6f},
                                    {75.f, 50.f, 2.4f},
                                    {3.2f, 117.9f, 2.f},
                                    {158.6f, 1.1f, 3.7f},
                                    {80.5f, 60.25f, 9.3f}}) {
    for (const float angle : {0.f, 0.7f, -2.9f}) {
      Feature feature;
      feature.x_px = x;
      feature.y_px = y;
      feature.sigma_px = sigma;
      feature.angle_rad = angle;
      const auto expected = reference_descriptor(image, x, y, sigma, angle);
      for (const bool upright : {false, true}) {
        if (upright && angle != 0.f) continue;
        Descriptor descriptor;
        describe(integral, feature, upright, descriptor);
        for (std::size_t k = 0; k < descriptor.size(); ++k)
          ASSERT_NEAR(descriptor[k], expected[k], 2e-4)
              << "at " << x << ", " << y << " angle " << angle << " element " << k;
      }
    }
  }
}

TEST(FeaturesReference, OrientationIsNearThePlainOne) {
  const TestImage image = textured(200, 200, 4);
  const IntegralImage integral = integral_of(image);
  FeatureExtractor extractor(image.width_px, image.height_px, {.max_features = 60});
  FeatureSet features;
  extractor.extract(image.view(), features);
  int near = 0;
  for (const Feature& feature : features.features) {
    const double expected = reference_orientation(image, feature.x_px, feature.y_px, feature.sigma_px);
    near += angle_between(dominant_orientation(integral, feature), expected) < 5.0 * std::numbers::pi / 180.0;
  }
  // The rest have two windows of nearly equal length, between which 5° bins may decide otherwise.
  ASSERT_GT(features.features.size(), 30U);
  EXPECT_GE(near, static_cast<int>(0.9 * static_cast<double>(features.features.size())));
}

TEST(FeaturesReference, OrientationTurnsWithThePicture) {
  for (const double turn : {0.0, 0.4, 1.3, 2.8, -1.9}) {
    // A dark disc beside a light one: the gradient at the middle points to the light one.
    const double c = std::cos(turn), s = std::sin(turn);
    const Blob dark{64 - 8 * c, 64 - 8 * s, 5.0, -90.0}, light{64 + 8 * c, 64 + 8 * s, 5.0, 90.0};
    const auto image = image_of(129, 129, [&](double x, double y) { return 128 + dark(x, y) + light(x, y); });
    Feature feature;
    feature.x_px = feature.y_px = 64.f;
    feature.sigma_px = 3.f;
    EXPECT_LT(angle_between(dominant_orientation(integral_of(image), feature), turn),
              0.06);  // boxes are square, not round
  }
}

TEST(FeaturesReference, EveryInstructionSetFindsTheSame) {
  const TestImage image = textured(331, 247, 5);
  for (const bool oriented : {false, true}) {
    FeatureExtractor extractor(image.width_px, image.height_px,
                               {.octaves = 4, .max_features = 500, .oriented = oriented});
    FeatureSet expected;
    std::vector<Match> expected_matches;
    int targets = 0;
    for_each_target([&] {
      FeatureSet features;
      extractor.extract(image.view(), features);
      if (targets++ == 0) expected = features;
      ASSERT_GT(features.features.size(), 100U);
      ASSERT_EQ(features.features.size(), expected.features.size());
      for (std::size_t i = 0; i < features.features.size(); ++i) {
        ASSERT_EQ(features.features[i].x_px, expected.features[i].x_px);
        ASSERT_EQ(features.features[i].y_px, expected.features[i].y_px);
        ASSERT_EQ(features.features[i].sigma_px, expected.features[i].sigma_px);
        ASSERT_EQ(features.features[i].angle_rad, expected.features[i].angle_rad);
        ASSERT_EQ(features.features[i].response, expected.features[i].response);
        ASSERT_EQ(features.descriptors[i], expected.descriptors[i]);
      }
      Matcher matcher(500, 500, {.ratio = 0.9f});
      std::vector<Match> matches;
      FeatureSet half = features;
      half.features.resize(150);
      half.descriptors.resize(150);
      matcher.match(half, features, matches);
      if (expected_matches.empty()) expected_matches = matches;
      ASSERT_EQ(matches.size(), expected_matches.size());
      for (std::size_t i = 0; i < matches.size(); ++i) ASSERT_EQ(matches[i].cur, expected_matches[i].cur);
    });
#if defined(__x86_64__)
    EXPECT_GE(targets, 2);
#endif
  }
}

}  // namespace
}  // namespace heel::test
