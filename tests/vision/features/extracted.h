// Features of a synthetic image.
#pragma once

#include "heel/features.h"
#include "vision/features/test_image.h"

namespace heel::test {

inline FeatureSet extract(const TestImage& image, const FeatureSettings& settings,
                          const Region& region = {}) {
  FeatureExtractor extractor(image.width_px, image.height_px, settings);
  FeatureSet features;
  extractor.reserve(features);
  extractor.extract(image.view(), region, features);
  return features;
}

}  // namespace heel::test
