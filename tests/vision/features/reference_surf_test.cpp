// The fast implementation against the reference implementation (reference_surf.h), stage by stage, and
// against itself on every instruction set.
#include "vision/features/reference_surf.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include "core/angles.h"
#include "heel/features.h"
#include "heel/matching.h"
#include "support/each_simd_target.h"
#include "vision/features/descriptor.h"
#include "vision/features/fast_hessian.h"
#include "vision/features/hessian_rows.h"
#include "vision/features/integral_image.h"
#include "vision/features/keypoint_selection.h"
#include "vision/features/orientation.h"
#include "vision/features/scale_space_fit.h"
#include "vision/features/simd_target.h"

namespace heel {
namespace {

using test::Blob;
using test::BlobField;
using test::box_sum;
using test::image_of;
using test::noise_image;
using test::reference_descriptor;
using test::reference_hessian;
using test::reference_orientation;
using test::ReferenceHessian;
using test::TestImage;

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
  return std::abs(wrap_angle_rad(a - b));
}

TEST(ReferenceSurf, IntegralImageIsTheSumOfPixels) {
  for (const auto& [width, height] : {std::pair{1, 1}, {15, 3}, {16, 16}, {17, 5}, {64, 2}, {131, 37}}) {
    const TestImage image = noise_image(width, height, 1);
    const IntegralImage integral = integral_of(image);
    for (int y = 0; y <= height; ++y) {
      for (int x = 0; x <= width; ++x)
        ASSERT_EQ(integral.row(y)[x], static_cast<std::uint32_t>(box_sum(image, 0, 0, x, y)));
    }
  }
}

TEST(ReferenceSurf, HessianRowsEqualThePaperToSixDigits) {
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

TEST(ReferenceSurf, ResponsePatchesEqualTheRows) {
  const TestImage image = noise_image(211, 203, 6);
  const IntegralImage integral = integral_of(image);
  HessianRowWork work(image.width_px);
  std::vector<float> response(static_cast<std::size_t>(image.width_px + kResponsePadding));
  for (const int lobe : {3, 9, 17, 33}) {
    for (const int step : {1, 2, 4, 8}) {
      const BoxFilter filter{lobe};
      const int x = 13 * 8, y = 12 * 8, column = x / step;
      ResponsePatch patch;
      ASSERT_TRUE(hessian_response_patch(integral, filter, x, y, step, 1e9f, patch));
      float largest = -1e9f;
      for (int j = 0; j < 3; ++j) {
        hessian_response_row(integral, filter, y + (j - 1) * step, step, column - 1, column + 2, work,
                             response.data());
        for (int i = 0; i < 3; ++i) {
          const float here = patch[static_cast<std::size_t>(j)][static_cast<std::size_t>(i)];
          EXPECT_EQ(here, response[static_cast<std::size_t>(column - 1 + i)]) << "lobe " << lobe;
          largest = std::max(largest, here);
        }
      }
      EXPECT_TRUE(hessian_response_patch(integral, filter, x, y, step, largest, patch));
      EXPECT_FALSE(
          hessian_response_patch(integral, filter, x, y, step, std::nextafter(largest, -1.f), patch));
    }
  }
}

/// Every sample of every layer computed and compared; keypoints of octave 0 from top to bottom.
std::vector<Feature> keypoints_of_octave_0(const IntegralImage& integral, float threshold) {
  const int width = integral.width_px(), height = integral.height_px();
  HessianRowWork work(width);
  std::vector<std::vector<float>> layers[kLayersPerOctave];
  for (int layer = 0; layer < kLayersPerOctave; ++layer) {
    const BoxFilter filter = octave_filter(0, layer);
    for (int y = 0; y < height; ++y) {
      layers[layer].emplace_back(static_cast<std::size_t>(width + kResponsePadding));
      if (y < filter.half() || y >= height - filter.half()) continue;
      hessian_response_row(integral, filter, y, 1, filter.half(), width - filter.half(), work,
                           layers[layer].back().data());
    }
  }
  std::vector<Feature> keypoints;
  for (int layer = 1; layer + 1 < kLayersPerOctave; ++layer) {
    const int border = octave_filter(0, layer + 1).half() + 1;
    for (int y = border; y < height - border; ++y) {
      for (int x = border; x < width - border; ++x) {
        ResponseCube cube;
        for (std::size_t l = 0; l < 3; ++l) {
          for (std::size_t j = 0; j < 3; ++j) {
            const std::vector<float>& row =
                layers[layer - 1 + static_cast<int>(l)][static_cast<std::size_t>(y - 1) + j];
            std::copy_n(row.data() + x - 1, 3, cube[l][j].data());
          }
        }
        if (!(cube[1][1][1] > threshold)) continue;
        const auto peak = fit_scale_space_peak(cube);
        if (!peak || !(peak->response > threshold)) continue;
        Feature keypoint;
        keypoint.x_px = static_cast<float>(x) + peak->dx;
        keypoint.y_px = static_cast<float>(y) + peak->dy;
        keypoint.sigma_px = BoxFilter::kSigmaPerSide *
                            (static_cast<float>(octave_filter(0, layer).side()) + 6.f * peak->dlayer);
        keypoint.response = peak->response;
        keypoints.push_back(keypoint);
      }
    }
  }
  std::sort(keypoints.begin(), keypoints.end(), stronger);
  return keypoints;
}

// The detector computes its outer layers only where needed, round single samples or by the row: few samples
// with blobs, all with noise, whole rows with a checkerboard, which also has ties.
TEST(ReferenceSurf, DetectorAgreesWithComparingEverySample) {
  const auto board = [](int period, double unevenness) {
    return image_of(150, 110, [&](double x, double y) {
      const bool dark = (static_cast<int>(x) / period + static_cast<int>(y) / period) % 2 != 0;
      return (dark ? 10.0 : 245.0) + unevenness * std::sin(0.37 * x + 0.11 * y);
    });
  };
  for (const TestImage& image : {textured(150, 110, 7), noise_image(150, 110, 8), board(7, 0), board(7, 9)}) {
    const IntegralImage integral = integral_of(image);
    const std::vector<Feature> expected = keypoints_of_octave_0(integral, 1e-4f);
    FeatureExtractor extractor(150, 110, {.octaves = 1, .max_features = 20000, .spread = false});
    FeatureSet found;
    extractor.extract(image.view(), found);
    ASSERT_GE(expected.size(), 20U);
    ASSERT_EQ(found.features.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
      ASSERT_EQ(found.features[i].x_px, expected[i].x_px) << "keypoint " << i;
      ASSERT_EQ(found.features[i].y_px, expected[i].y_px) << "keypoint " << i;
      ASSERT_EQ(found.features[i].sigma_px, expected[i].sigma_px) << "keypoint " << i;
      ASSERT_EQ(found.features[i].response, expected[i].response) << "keypoint " << i;
    }
  }
}

TEST(ReferenceSurf, DescriptorsEqualTheReference) {
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

TEST(ReferenceSurf, OrientationIsNearTheReference) {
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
  // The others have two windows of nearly equal length; with bins the other one may be the longest.
  ASSERT_GT(features.features.size(), 30U);
  EXPECT_GE(near, static_cast<int>(0.9 * static_cast<double>(features.features.size())));
}

TEST(ReferenceSurf, OrientationTurnsWithThePicture) {
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

TEST(ReferenceSurf, OneProgramContainsEveryInstructionSet) {
#if defined(__x86_64__)
  EXPECT_THAT(compiled_simd_targets(), ::testing::ElementsAre("AVX3", "AVX2", "SSE4", "SSSE3", "EMU128"));
  EXPECT_EQ(available_simd_targets().back(), "EMU128");  // plain SSE2, which every x86-64 processor has
#elif defined(__aarch64__)
  EXPECT_THAT(compiled_simd_targets(), ::testing::ElementsAre("NEON"));
#endif
  EXPECT_EQ(simd_target_name(), available_simd_targets().front());
  std::vector<std::string_view> used;
  test::for_each_simd_target([&] { used.emplace_back(simd_target_name()); });
  EXPECT_EQ(used, available_simd_targets());
  EXPECT_FALSE(use_simd_target("MMX"));
  EXPECT_EQ(simd_target_name(), available_simd_targets().front());
}

TEST(ReferenceSurf, EveryInstructionSetFindsTheSame) {
  const TestImage image = textured(331, 247, 5);
  for (const bool oriented : {false, true}) {
    FeatureExtractor extractor(image.width_px, image.height_px,
                               {.octaves = 4, .max_features = 500, .oriented = oriented});
    FeatureSet expected;
    std::vector<Match> expected_matches;
    int targets = 0;
    test::for_each_simd_target([&] {
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
    EXPECT_EQ(targets, static_cast<int>(available_simd_targets().size()));
  }
}

}  // namespace
}  // namespace heel
