#include "vision/descriptor.h"

#include <array>
#include <cmath>
#include <cstddef>

#include "vision/box_grid.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vision/descriptor.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef HEEL_VISION_DESCRIPTOR_WEIGHTS
#define HEEL_VISION_DESCRIPTOR_WEIGHTS
namespace heel::descriptor_weights {

inline constexpr int kResponses = kPatchCells - 1;  // along a side
inline constexpr int kCells = 4;                    // subregions along a side
inline constexpr int kCellSide = 9;
inline constexpr int kCellStep = 5;
static_assert(kCellStep * (kCells - 1) + kCellSide == kResponses);

struct Weights {
  std::array<float, kCellSide> inside{};  // of a response in its subregion
  std::array<float, kCells> across{};     // of a subregion in the descriptor
  Weights() {
    constexpr double kInsideSigma = 2.0, kAcrossSigma = 1.5;
    for (int i = 0; i < kCellSide; ++i) {
      const double off = (i - (kCellSide - 1) / 2) / kInsideSigma;
      inside[static_cast<std::size_t>(i)] = static_cast<float>(std::exp(-0.5 * off * off));
    }
    for (int i = 0; i < kCells; ++i) {
      const double off = (i - 0.5 * (kCells - 1)) / kAcrossSigma;
      across[static_cast<std::size_t>(i)] = static_cast<float>(std::exp(-0.5 * off * off));
    }
  }
};
inline const Weights kWeights;

}  // namespace heel::descriptor_weights
#endif

HWY_BEFORE_NAMESPACE();
namespace heel::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using namespace descriptor_weights;
using F32 = hn::CappedTag<float, 16>;
using Four = hn::FixedTag<float, 4>;

constexpr int kColumns = 32;  // kResponses rounded up to whole vectors

// Sums down the columns of one row of subregions: [column][Σdx, Σdy, Σ|dx|, Σ|dy|].
HWY_INLINE void sum_columns(const Patch& cells, int first_row, float* sums) {
  const F32 d;
  for (int i = 0; i < kResponses; i += static_cast<int>(hn::Lanes(d))) {
    auto sum_dx = hn::Zero(d), sum_dy = sum_dx, sum_abs_dx = sum_dx, sum_abs_dy = sum_dx;
    const float* row = cells.data() + first_row * kPatchStride + i;
    for (int k = 0; k < kCellSide; ++k, row += kPatchStride) {
      // A Haar response of side two cells, from the four cells round its centre.
      const auto top_left = hn::LoadU(d, row), top_right = hn::LoadU(d, row + 1);
      const auto bottom_left = hn::LoadU(d, row + kPatchStride);
      const auto bottom_right = hn::LoadU(d, row + kPatchStride + 1);
      const auto falling = hn::Sub(bottom_right, top_left), rising = hn::Sub(top_right, bottom_left);
      const auto dx = hn::Add(falling, rising), dy = hn::Sub(falling, rising);
      const auto weight = hn::Set(d, kWeights.inside[static_cast<std::size_t>(k)]);
      sum_dx = hn::Add(sum_dx, hn::Mul(weight, dx));
      sum_dy = hn::Add(sum_dy, hn::Mul(weight, dy));
      sum_abs_dx = hn::Add(sum_abs_dx, hn::Mul(weight, hn::Abs(dx)));
      sum_abs_dy = hn::Add(sum_abs_dy, hn::Mul(weight, hn::Abs(dy)));
    }
    hn::StoreInterleaved4(sum_dx, sum_dy, sum_abs_dx, sum_abs_dy, d, sums + 4 * i);
  }
}

void SumSubregions(const Patch& cells, Descriptor& descriptor) {
  const Four d4;
  HWY_ALIGN float sums[4 * kColumns];
  auto squares = hn::Zero(d4);
  for (int cy = 0; cy < kCells; ++cy) {
    sum_columns(cells, cy * kCellStep, sums);
    for (int cx = 0; cx < kCells; ++cx) {
      auto sum = hn::Zero(d4);
      for (int k = 0; k < kCellSide; ++k) {
        const auto weight = hn::Set(d4, kWeights.inside[static_cast<std::size_t>(k)]);
        sum = hn::Add(sum, hn::Mul(weight, hn::Load(d4, sums + 4 * (cx * kCellStep + k))));
      }
      sum = hn::Mul(sum, hn::Set(d4, kWeights.across[static_cast<std::size_t>(cy)] *
                                         kWeights.across[static_cast<std::size_t>(cx)]));
      squares = hn::Add(squares, hn::Mul(sum, sum));
      hn::StoreU(sum, d4, descriptor.data() + 4 * (cy * kCells + cx));
    }
  }
  HWY_ALIGN float parts[4];
  hn::Store(squares, d4, parts);
  const float norm = std::sqrt((parts[0] + parts[1]) + (parts[2] + parts[3]));
  const auto scale = hn::Set(d4, norm > 0.f ? 1.f / norm : 0.f);
  for (std::size_t i = 0; i < kDescriptorSize; i += 4)
    hn::StoreU(hn::Mul(scale, hn::LoadU(d4, descriptor.data() + i)), d4, descriptor.data() + i);
}

}  // namespace
}  // namespace heel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heel {

HWY_EXPORT(SumSubregions);

void describe(const IntegralImage& integral, const Feature& feature, bool upright, Descriptor& descriptor) {
  Patch cells;
  if (upright) {
    sample_upright_cells(integral, feature.x_px, feature.y_px, feature.sigma_px, cells);
  } else {
    sample_rotated_cells(integral, feature.x_px, feature.y_px, feature.sigma_px, std::cos(feature.angle_rad),
                         std::sin(feature.angle_rad), cells);
  }
  HWY_DYNAMIC_DISPATCH(SumSubregions)(cells, descriptor);
}

}  // namespace heel
#endif  // HWY_ONCE
