// Every processor finds the same features of a drawn picture: those of the golden file.
//
// The golden file says where it comes from in its first lines. It is rewritten only when asked:
//   HEEL_UPDATE_GOLDEN=1 build/release/bin/test_golden_features
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "core/angles.h"
#include "heel/features.h"
#include "support/each_simd_target.h"
#include "support/temporary_folder.h"
#include "support/test_data.h"
#include "vision/features/test_image.h"

namespace heel {
namespace {

using test::for_each_simd_target;
using test::source_path;
using test::TestImage;
using test::write_text;

const std::string kGoldenFile = source_path("tests/golden/features/discs.golden");
constexpr const char* kProvenance =
    "# Features of 400 grey discs, drawn and blurred in whole numbers by test_golden_features.\n"
    "# Made by it with HEEL_UPDATE_GOLDEN=1; compared on every instruction set, within: x, y and sigma 1e-4 "
    "px,\n"
    "# angle 1e-5 rad, response 1e-5 of itself, descriptor elements 1e-6.\n"
    "# oriented x_px y_px sigma_px angle_rad response laplacian, and 64 elements of the descriptor, "
    "strongest\n"
    "# first\n";
constexpr int kFeatures = 40;

/// Whole numbers only, so that every processor draws the same picture.
TestImage discs() {
  std::mt19937 random(2010);
  const auto below = [&](int end) { return static_cast<int>(random() % static_cast<unsigned>(end)); };
  TestImage sharp(320, 240);
  for (int i = 0; i < 400; ++i) {
    const int x0 = below(sharp.width_px), y0 = below(sharp.height_px);
    const int radius = 2 + below(14), level = below(256);
    for (int y = std::max(y0 - radius, 0); y <= std::min(y0 + radius, sharp.height_px - 1); ++y) {
      for (int x = std::max(x0 - radius, 0); x <= std::min(x0 + radius, sharp.width_px - 1); ++x)
        if ((x - x0) * (x - x0) + (y - y0) * (y - y0) <= radius * radius)
          sharp.at(x, y) = static_cast<std::uint8_t>(level);
    }
  }
  TestImage blurred = sharp;
  for (int y = 1; y + 1 < sharp.height_px; ++y) {
    for (int x = 1; x + 1 < sharp.width_px; ++x) {
      int sum = 0;
      for (int v = -1; v <= 1; ++v)
        for (int u = -1; u <= 1; ++u) sum += (2 - u * u) * (2 - v * v) * sharp.at(x + u, y + v);
      blurred.at(x, y) = static_cast<std::uint8_t>(sum / 16);
    }
  }
  return blurred;
}

FeatureSet features_of(const TestImage& image, bool oriented) {
  FeatureExtractor extractor(image.width_px, image.height_px,
                             {.octaves = 3, .max_features = kFeatures, .oriented = oriented});
  FeatureSet features;
  extractor.extract(image.view(), features);
  return features;
}

/// With nine digits a float is read back to the bit.
std::string golden_text(const TestImage& image) {
  std::string text = kProvenance;
  char number[40];
  for (const bool oriented : {false, true}) {
    const FeatureSet set = features_of(image, oriented);
    for (std::size_t i = 0; i < set.features.size(); ++i) {
      const Feature& f = set.features[i];
      text += oriented ? '1' : '0';
      for (const float value : {f.x_px, f.y_px, f.sigma_px, f.angle_rad, f.response}) {
        std::snprintf(number, sizeof number, " %.9g", static_cast<double>(value));
        text += number;
      }
      text += ' ' + std::to_string(f.laplacian);
      for (const float element : set.descriptors[i]) {
        std::snprintf(number, sizeof number, " %.9g", static_cast<double>(element));
        text += number;
      }
      text += '\n';
    }
  }
  return text;
}

FeatureSet golden_features(bool oriented) {
  FeatureSet set;
  std::ifstream golden(kGoldenFile);
  EXPECT_TRUE(golden) << kGoldenFile;
  for (std::string line; std::getline(golden, line);) {
    if (line.starts_with('#') || line.starts_with('1') != oriented) continue;
    std::istringstream in(line);
    int is_oriented = 0, sign = 0;
    Feature f;
    Descriptor descriptor;
    in >> is_oriented >> f.x_px >> f.y_px >> f.sigma_px >> f.angle_rad >> f.response >> sign;
    for (float& element : descriptor) in >> element;
    EXPECT_TRUE(in) << line;
    f.laplacian = static_cast<std::int8_t>(sign);
    set.features.push_back(f);
    set.descriptors.push_back(descriptor);
  }
  return set;
}

/// The largest differences, printed at the end; 0: equal to the bit.
struct Differences {
  double px = 0, angle_rad = 0, response = 0, descriptor = 0;
  void add(const Feature& a, const Descriptor& descriptor_a, const Feature& b,
           const Descriptor& descriptor_b) {
    const auto keep = [](double& most, double x, double y) { most = std::max(most, std::abs(x - y)); };
    keep(px, a.x_px, b.x_px);
    keep(px, a.y_px, b.y_px);
    keep(px, a.sigma_px, b.sigma_px);
    keep(angle_rad, wrap_angle_rad(double{a.angle_rad} - double{b.angle_rad}), 0);
    keep(response, double{a.response} / double{b.response}, 1);
    for (std::size_t k = 0; k < descriptor_a.size(); ++k) keep(descriptor, descriptor_a[k], descriptor_b[k]);
  }
};

TEST(FeaturesGolden, AreTheSameOnEveryProcessor) {
  const TestImage image = discs();
  if (std::getenv("HEEL_UPDATE_GOLDEN") != nullptr) {
    write_text(kGoldenFile, golden_text(image));
    GTEST_SKIP() << "wrote " << kGoldenFile;
  }
  for (const bool oriented : {false, true}) {
    const FeatureSet expected = golden_features(oriented);
    ASSERT_EQ(expected.features.size(), static_cast<std::size_t>(kFeatures));
    for_each_simd_target([&] {
      const FeatureSet found = features_of(image, oriented);
      ASSERT_EQ(found.features.size(), expected.features.size());
      Differences most;
      for (std::size_t i = 0; i < found.features.size(); ++i) {
        EXPECT_EQ(found.features[i].laplacian, expected.features[i].laplacian);
        most.add(found.features[i], found.descriptors[i], expected.features[i], expected.descriptors[i]);
      }
      EXPECT_LE(most.px, 1e-4);
      EXPECT_LE(most.angle_rad, 1e-5);
      EXPECT_LE(most.response, 1e-5);
      EXPECT_LE(most.descriptor, 1e-6);
      std::printf("%s %s: largest differences %g px, %g rad, %g of the response, %g in a descriptor\n",
                  simd_target_name(), oriented ? "oriented" : "upright", most.px, most.angle_rad,
                  most.response, most.descriptor);
    });
  }
}

}  // namespace
}  // namespace heel
