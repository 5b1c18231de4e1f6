// After reserve(), extracting and matching allocate nothing.
#include <gtest/gtest.h>

#include "heel/features.h"
#include "heel/matching.h"
#include "support/allocation_count.h"
#include "vision/features/test_image.h"

namespace heel {
namespace {

using test::allocations_of_this_thread;
using test::BlobField;
using test::counts_allocations;
using test::image_of;
using test::noise_image;
using test::TestImage;

TEST(FeatureExtractorMemory, ExtractAndMatchAllocateNothing) {
  if (!counts_allocations()) GTEST_SKIP() << "a sanitizer owns the allocator";
  const TestImage noise = noise_image(320, 240, 1);
  const TestImage texture = image_of(320, 240, BlobField(320, 240, 300, 2));
  FeatureSettings settings{.octaves = 4, .max_features = 100, .threshold = 1e-6f, .oriented = true};
  FeatureExtractor extractor(320, 240, settings);
  FeatureSet ref, cur;
  extractor.reserve(ref);
  extractor.reserve(cur);
  Matcher matcher(100, 100, {});
  std::vector<Match> matches;
  matches.reserve(100);

  const std::uint64_t before = allocations_of_this_thread();
  for (const bool spread : {false, true}) {
    settings.spread = spread;
    extractor.set_settings(settings);
    extractor.extract(noise.view(), ref);
    extractor.extract(texture.view(), Region{40, 30, 200, 190}, cur);
    matcher.match(ref, cur, matches);
    extractor.extract(texture.view(), ref);
    matcher.match(ref, cur, matches);
    settings.upsample = true;
    extractor.set_settings(settings);
    extractor.extract(texture.view(), Region{100, 80, 120, 70}, cur);
    settings.upsample = false;
  }
  EXPECT_EQ(allocations_of_this_thread() - before, 0U);
  EXPECT_EQ(ref.features.size(), 100U);
  EXPECT_FALSE(matches.empty());
}

}  // namespace
}  // namespace heel
