// The verdict on synthetic shirts of obvious quality, and on a real one.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <string>

#include "heel/shirt_template.h"
#include "support/test_data.h"

namespace heel {
namespace {

using ::testing::HasSubstr;

constexpr int kWidth_px = 640;
constexpr int kHeight_px = 480;

/// A shirt of 160 × 200 px in front of a uniform grey wall, with sensor noise of one grey level.
ShirtTemplate shirt_with(const cv::Mat& cloth) {
  cv::Mat image(kHeight_px, kWidth_px, CV_8UC1, cv::Scalar(90));
  const cv::Rect place(220, 120, 160, 200);
  cloth(cv::Rect(0, 0, place.width, place.height)).copyTo(image(place));
  cv::Mat noise(image.size(), CV_16SC1);
  cv::RNG(7).fill(noise, cv::RNG::NORMAL, 0, 1.0);
  cv::add(image, noise, image, cv::noArray(), CV_8UC1);

  ShirtTemplate shirt;
  shirt.camera.width_px = kWidth_px;
  shirt.camera.height_px = kHeight_px;
  shirt.camera.fx = shirt.camera.fy = 600.0;
  shirt.camera.cx = kWidth_px / 2.0;
  shirt.camera.cy = kHeight_px / 2.0;
  shirt.grey.assign(image.datastart, image.dataend);
  shirt.roi = {place.x, place.y, place.width, place.height};
  shirt.distance_m = 1.5;
  return shirt;
}

cv::Mat plain(int grey = 130) {
  return cv::Mat(kHeight_px, kWidth_px, CV_8UC1, cv::Scalar(grey));
}

/// Blobs, bars and rings of many sizes: no two places are similar.
cv::Mat print(std::uint64_t seed = 3) {
  cv::Mat cloth = plain();
  cv::RNG random(seed);
  for (int i = 0; i < 220; ++i) {
    const cv::Point at(random.uniform(0, 170), random.uniform(0, 210));
    const cv::Scalar grey(random.uniform(20, 240));
    const int size = 2 + static_cast<int>(16 * std::pow(random.uniform(0.0, 1.0), 2));
    if (i % 3 == 0) {
      cv::circle(cloth, at, size, grey, cv::FILLED, cv::LINE_AA);
    } else if (i % 3 == 1) {
      cv::ellipse(cloth, at, {size, size / 2 + 1}, random.uniform(0, 180), 0, 360, grey, cv::FILLED,
                  cv::LINE_AA);
    } else {
      cv::rectangle(cloth, at, at + cv::Point(size, 2 + size / 2), grey, cv::FILLED);
    }
  }
  return cloth;
}

cv::Mat pattern(const std::function<bool(int x, int y)>& dark) {
  cv::Mat cloth(kHeight_px, kWidth_px, CV_8UC1);
  for (int y = 0; y < cloth.rows; ++y) {
    for (int x = 0; x < cloth.cols; ++x) cloth.at<std::uint8_t>(y, x) = dark(x, y) ? 60 : 190;
  }
  cv::GaussianBlur(cloth, cloth, {}, 0.7);
  return cloth;
}

TEST(TemplateQuality, TakesAPrintedShirt) {
  const TemplateVerdict verdict = judge_template(shirt_with(print()));
  EXPECT_TRUE(verdict.usable) << verdict.reason;
  EXPECT_EQ(verdict.reason, "");
  EXPECT_GT(verdict.features, 100);
  EXPECT_GT(verdict.spread, 0.9);
  EXPECT_LT(verdict.self_similarity, 0.3);
  EXPECT_GT(verdict.coarse_share, 0.1);
}

TEST(TemplateQuality, RefusesAPlainShirt) {
  const TemplateVerdict verdict = judge_template(shirt_with(plain()));
  EXPECT_FALSE(verdict.usable);
  EXPECT_THAT(verdict.reason, HasSubstr("too plain"));
}

TEST(TemplateQuality, RefusesStripes) {
  for (const int period_px : {12, 20, 32}) {
    const cv::Mat cloth = pattern([&](int, int y) { return (y / (period_px / 2)) % 2 == 0; });
    const TemplateVerdict verdict = judge_template(shirt_with(cloth));
    EXPECT_FALSE(verdict.usable) << "period " << period_px << ": " << verdict.features
                                 << " features, self-similar " << verdict.self_similarity << ", spread "
                                 << verdict.spread;
    EXPECT_NE(verdict.reason, "") << "period " << period_px;
  }
}

TEST(TemplateQuality, RefusesACheckBecauseItRepeats) {
  for (const int period_px : {10, 16, 24}) {
    const cv::Mat cloth =
        pattern([&](int x, int y) { return ((x / (period_px / 2)) + (y / (period_px / 2))) % 2 == 0; });
    const TemplateVerdict verdict = judge_template(shirt_with(cloth));
    EXPECT_FALSE(verdict.usable) << "period " << period_px << ": self-similar " << verdict.self_similarity;
    EXPECT_THAT(verdict.reason, HasSubstr("repeats")) << "period " << period_px;
  }
}

TEST(TemplateQuality, RefusesUniformGrainBecauseItIsSimilarEverywhere) {
  cv::Mat grain(kHeight_px, kWidth_px, CV_32FC1);
  cv::RNG(11).fill(grain, cv::RNG::NORMAL, 0, 1);
  cv::Mat fine, coarse, cloth;
  cv::GaussianBlur(grain, fine, {}, 1.0);
  cv::GaussianBlur(grain, coarse, {}, 1.6);
  cv::Mat(fine - coarse).convertTo(cloth, CV_8UC1, 180, 130);
  const TemplateVerdict verdict = judge_template(shirt_with(cloth));
  EXPECT_FALSE(verdict.usable);
  EXPECT_THAT(verdict.reason, HasSubstr("repeats"));
}

TEST(TemplateQuality, RefusesAPatternThatIsGoneAtTwiceTheDistance) {
  // Small print: each feature is different from the others, but at half the size none is left. Set pixel by
  // pixel, so that it is the same on every processor.
  cv::Mat cloth = plain();
  cv::RNG random(5);
  constexpr int kMark_px = 7, kStep_px = 20;
  for (int top = 12; top + 12 < cloth.rows; top += kStep_px) {
    for (int left = 12; left + 12 < cloth.cols; left += kStep_px) {
      for (int y = 0; y < kMark_px; ++y)
        for (int x = 0; x < kMark_px; ++x)
          cloth.at<std::uint8_t>(top + y, left + x) =
              static_cast<std::uint8_t>(random.uniform(0, 2) * 100 + 80);
    }
  }
  const TemplateVerdict verdict = judge_template(shirt_with(cloth));
  EXPECT_FALSE(verdict.usable) << verdict.features << " features, coarse " << verdict.coarse_share;
  EXPECT_THAT(verdict.reason, HasSubstr("too fine"))
      << verdict.self_similarity << " " << verdict.coarse_share;
}

TEST(TemplateQuality, RefusesPrintInOneCornerOnly) {
  cv::Mat cloth = plain();
  print()(cv::Rect(0, 0, 75, 75)).copyTo(cloth(cv::Rect(0, 0, 75, 75)));
  const TemplateVerdict verdict = judge_template(shirt_with(cloth));
  EXPECT_FALSE(verdict.usable) << verdict.spread;
  EXPECT_THAT(verdict.reason, HasSubstr("of the region"));
}

TEST(TemplateQuality, RefusesATooSmallRegion) {
  ShirtTemplate shirt = shirt_with(print());
  shirt.roi.width_px = 31;
  const TemplateVerdict verdict = judge_template(shirt);
  EXPECT_FALSE(verdict.usable);
  EXPECT_THAT(verdict.reason, HasSubstr("31 x 200 px"));
}

TEST(TemplateFeatures, LieInTheRegionOverAWideRangeOfScalesStrongestFirst) {
  ShirtTemplate shirt = shirt_with(print());
  shirt.max_features = 250;
  const FeatureSet set = template_features(shirt);
  ASSERT_EQ(set.features.size(), set.descriptors.size());
  ASSERT_LE(set.features.size(), 250u);
  ASSERT_GT(set.features.size(), 100u);
  const Region& roi = shirt.roi;
  float smallest_px = 1e9f;
  float largest_px = 0.f;
  float previous = 1e9f;
  for (const Feature& feature : set.features) {
    EXPECT_GE(feature.x_px, static_cast<float>(roi.x_px) - 1.f);
    EXPECT_LE(feature.x_px, static_cast<float>(roi.x_px + roi.width_px));
    EXPECT_GE(feature.y_px, static_cast<float>(roi.y_px) - 1.f);
    EXPECT_LE(feature.y_px, static_cast<float>(roi.y_px + roi.height_px));
    EXPECT_LE(feature.response, previous);
    previous = feature.response;
    smallest_px = std::min(smallest_px, feature.sigma_px);
    largest_px = std::max(largest_px, feature.sigma_px);
  }
  EXPECT_LT(smallest_px, 2.5f);
  EXPECT_GT(largest_px, 8.f);
}

/// A frame of the real video as a template.
ShirtTemplate real_shirt(int frame, const Region& roi) {
  cv::VideoCapture video(test::data_path("person/one-by-one.mp4"), cv::CAP_FFMPEG);
  ShirtTemplate shirt;
  for (int i = 0; i < frame; ++i) video.grab();
  cv::Mat image, grey;
  if (!video.read(image)) return shirt;
  cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
  shirt.camera.width_px = grey.cols;
  shirt.camera.height_px = grey.rows;
  shirt.camera.fx = shirt.camera.fy = 700.0;
  shirt.camera.cx = grey.cols / 2.0;
  shirt.camera.cy = grey.rows / 2.0;
  shirt.grey.assign(grey.datastart, grey.dataend);
  shirt.roi = roi;
  return shirt;
}

TEST(TemplateQuality, TakesTheRealKnitBack) {
  HEEL_NEEDS_TEST_DATA("person/one-by-one.mp4");
  const ShirtTemplate shirt = real_shirt(1000, {400, 90, 100, 175});
  ASSERT_FALSE(shirt.grey.empty()) << "the video cannot be read";
  const TemplateVerdict verdict = judge_template(shirt);
  EXPECT_TRUE(verdict.usable) << verdict.reason;
  EXPECT_EQ(verdict.spread, 1.0);
  EXPECT_LT(verdict.self_similarity, 0.25);
  EXPECT_GT(verdict.coarse_share, 0.08);
}

}  // namespace
}  // namespace heel
