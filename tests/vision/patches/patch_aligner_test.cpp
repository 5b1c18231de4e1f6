// Patches are found where an affine map of the picture puts them, to a fraction of a pixel, and nowhere else.
#include "vision/patches/patch_aligner.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "support/allocation_count.h"
#include "support/each_simd_target.h"
#include "vision/features/test_image.h"

namespace heel {
namespace {

using test::image_of;
using test::TestImage;

constexpr int kWidth_px = 320, kHeight_px = 240;

/// A print with detail of 5 to 30 px, no two places alike; `seed` makes another one.
double print_level(double x, double y, double seed = 0.0) {
  double sum = 0.0;
  for (int i = 1; i <= 12; ++i) {
    const double angle = 2.4 * i + seed, wavelength_px = 9.0 + 2.3 * i;
    sum += std::sin(2.0 * M_PI * (x * std::cos(angle) + y * std::sin(angle)) / wavelength_px + 1.7 * i * i);
  }
  return 128.0 + 22.0 * sum;
}

ShirtTemplate printed() {
  const TestImage image =
      image_of(kWidth_px, kHeight_px, [](double x, double y) { return print_level(x, y); });
  ShirtTemplate shirt;
  shirt.grey = image.grey;
  shirt.camera.width_px = kWidth_px;
  shirt.camera.height_px = kHeight_px;
  shirt.camera.fx = shirt.camera.fy = 300.0;
  shirt.roi = {80, 40, 160, 160};
  return shirt;
}

/// x_cur = cur_from_ref (x_ref − middle) + middle + shift.
struct AffineView {
  Eigen::Matrix2d cur_from_ref = Eigen::Matrix2d::Identity();
  Eigen::Vector2d shift_px = Eigen::Vector2d::Zero();
  double gain = 1.0, offset = 0.0;

  Eigen::Vector2d middle() const { return {160.0, 120.0}; }
  Eigen::Vector2d place(const Eigen::Vector2d& ref_px) const {
    return cur_from_ref * (ref_px - middle()) + middle() + shift_px;
  }
  TestImage image() const {
    const Eigen::Matrix2d inverse = cur_from_ref.inverse();
    return image_of(kWidth_px, kHeight_px, [&](double x, double y) {
      const Eigen::Vector2d ref_px = inverse * (Eigen::Vector2d(x, y) - shift_px - middle()) + middle();
      return offset + gain * print_level(ref_px.x(), ref_px.y());
    });
  }
  std::vector<PredictedPatch> predicted(const PatchAligner& aligner, const Eigen::Vector2d& error_px) const {
    std::vector<PredictedPatch> patches;
    for (const Eigen::Vector2d& px : aligner.centres_px())
      patches.push_back({place(px) + error_px, cur_from_ref});
    return patches;
  }
};

std::vector<AlignedPatch> aligned(const PatchAligner& aligner, const TestImage& image,
                                  const std::vector<PredictedPatch>& predicted) {
  std::vector<AlignedPatch> patches;
  aligner.align(image.view(), predicted, patches);
  return patches;
}

Eigen::Matrix2d matrix(double a, double b, double c, double d) {
  Eigen::Matrix2d m;
  m << a, b, c, d;
  return m;
}

TEST(PatchAligner, FindsPatchesWhereAnAffineMapPutsThem) {
  const PatchAligner aligner(printed(), PatchSettings{});
  ASSERT_EQ(aligner.centres_px().size(), PatchSettings{}.max_patches);
  const std::vector<AffineView> views{
      {matrix(1.0, 0.0, 0.0, 1.0), {2.3, -1.6}},
      {matrix(0.7, 0.1, -0.05, 0.95), {-4.4, 3.2}},
      {matrix(0.5, 0.0, 0.0, 0.5), {10.25, 0.5}, 0.6, 30.0},  // darker, with less contrast
      {matrix(1.2, -0.1, 0.15, 1.15), {0.4, 0.7}, 0.8, 20.0},
  };
  for (const AffineView& view : views) {
    const std::vector<AlignedPatch> found =
        aligned(aligner, view.image(), view.predicted(aligner, {1.4, -1.1}));
    EXPECT_GT(found.size(), 0.9 * static_cast<double>(aligner.centres_px().size())) << view.cur_from_ref;
    std::size_t precise = 0;
    for (const AlignedPatch& patch : found)
      if ((patch.px - view.place(aligner.centres_px()[patch.patch])).norm() < 0.12) ++precise;
    EXPECT_GT(precise, 0.9 * static_cast<double>(found.size())) << view.cur_from_ref;
  }
}

TEST(PatchAligner, EveryInstructionSetFindsTheSame) {
  const PatchAligner aligner(printed(), PatchSettings{});
  const AffineView view{matrix(0.8, 0.1, -0.05, 0.95), {-4.4, 3.2}, 0.8, 20.0};
  const TestImage image = view.image();
  const std::vector<PredictedPatch> predicted = view.predicted(aligner, {1.4, -1.1});
  std::vector<AlignedPatch> expected;
  test::for_each_simd_target([&] {
    const std::vector<AlignedPatch> found = aligned(aligner, image, predicted);
    ASSERT_FALSE(found.empty());
    if (expected.empty()) expected = found;
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_EQ(found[i].patch, expected[i].patch);
      EXPECT_EQ(found[i].px, expected[i].px);
      EXPECT_EQ(found[i].information, expected[i].information);
    }
  });
}

TEST(PatchAligner, FindsNothingInAnotherPrintNorInAPlainPicture) {
  const PatchAligner aligner(printed(), PatchSettings{});
  const std::vector<PredictedPatch> predicted = AffineView{}.predicted(aligner, {0.0, 0.0});
  const TestImage other =
      image_of(kWidth_px, kHeight_px, [](double x, double y) { return print_level(x, y, 0.9); });
  EXPECT_LT(aligned(aligner, other, predicted).size(), 0.1 * static_cast<double>(predicted.size()));
  EXPECT_TRUE(aligned(aligner, TestImage(kWidth_px, kHeight_px), predicted).empty());
}

TEST(PatchAligner, LeavesOutWhatTurnsAwayOrLiesOutside) {
  const PatchAligner aligner(printed(), PatchSettings{});
  const AffineView view;
  const TestImage image = view.image();
  std::vector<PredictedPatch> predicted = view.predicted(aligner, {0.0, 0.0});
  const std::size_t all = aligned(aligner, image, predicted).size();
  predicted[0].cur_from_ref = matrix(-1.0, 0.0, 0.0, 1.0);  // seen from inside
  predicted[1].cur_from_ref.setZero();
  predicted[2].px = {3.0, 100.0};
  predicted[3].px = {1e9, 1e9};
  EXPECT_EQ(aligned(aligner, image, predicted).size(), all - 4);
}

// Too far from the predicted place it is another detail that would be found.
TEST(PatchAligner, FindsNoPatchBeyondTheLargestShift) {
  const PatchAligner aligner(printed(), PatchSettings{});
  const AffineView view;
  for (const AlignedPatch& patch : aligned(aligner, view.image(), view.predicted(aligner, {7.0, 0.0}))) {
    const Eigen::Vector2d predicted_px =
        view.place(aligner.centres_px()[patch.patch]) + Eigen::Vector2d(7.0, 0.0);
    EXPECT_LT((patch.px - predicted_px).norm(), PatchSettings{}.max_shift_px);
  }
}

TEST(PatchAligner, AnEdgeCountsAlongItsNormal) {
  ShirtTemplate shirt = printed();
  const TestImage edges =
      image_of(kWidth_px, kHeight_px, [](double x, double) { return 128.0 + 80.0 * std::sin(x / 4.0); });
  shirt.grey = edges.grey;
  const PatchAligner aligner(shirt, PatchSettings{});
  const std::vector<AlignedPatch> found =
      aligned(aligner, edges, AffineView{}.predicted(aligner, {0.7, 0.0}));
  ASSERT_FALSE(found.empty());
  for (const AlignedPatch& patch : found) {
    EXPECT_NEAR(patch.px.x(), aligner.centres_px()[patch.patch].x(), 0.05);
    EXPECT_GT(patch.information(0, 0), 1.0);
    EXPECT_LT(patch.information(1, 1), 1e-3 * patch.information(0, 0));
  }
}

TEST(PatchAligner, ChoosesNoPlainPlaces) {
  ShirtTemplate shirt = printed();
  for (int y = 0; y < kHeight_px; ++y)
    for (int x = 0; x < 160; ++x) shirt.grey[static_cast<std::size_t>(y * kWidth_px + x)] = 128;
  const PatchAligner aligner(shirt, PatchSettings{});
  ASSERT_FALSE(aligner.centres_px().empty());
  for (const Eigen::Vector2d& px : aligner.centres_px())
    EXPECT_GT(px.x(), 160.0 - PatchSettings{}.half_size_px - 2.0);
}

TEST(PatchAligner, AllocatesNothing) {
  if (!test::counts_allocations()) GTEST_SKIP() << "a sanitizer owns the allocator";
  const PatchAligner aligner(printed(), PatchSettings{});
  const AffineView view;
  const TestImage image = view.image();
  const std::vector<PredictedPatch> predicted = view.predicted(aligner, {0.5, 0.5});
  std::vector<AlignedPatch> found;
  found.reserve(predicted.size());
  const std::uint64_t before = test::allocations_of_this_thread();
  aligner.align(image.view(), predicted, found);
  EXPECT_EQ(test::allocations_of_this_thread() - before, 0u);
  EXPECT_FALSE(found.empty());
}

}  // namespace
}  // namespace heel
