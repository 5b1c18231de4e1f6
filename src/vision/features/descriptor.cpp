#include "vision/features/descriptor.h"

#include <array>
#include <cmath>
#include <cstddef>

#include "vision/features/box_grid.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vision/features/descriptor.cpp"
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
static_assert(kCellSide <= 2 * kCellStep);  // a response belongs to two subregions at most

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

// Haar responses two cells wide, each from the four cells round its centre.
struct Haar {
  hn::Vec<F32> dx, dy;
};

HWY_INLINE Haar haar_responses(const float* cells) {
  const F32 d;
  const auto falling = hn::Sub(hn::LoadU(d, cells + kPatchStride + 1), hn::LoadU(d, cells));
  const auto rising = hn::Sub(hn::LoadU(d, cells + 1), hn::LoadU(d, cells + kPatchStride));
  return {hn::Add(falling, rising), hn::Sub(falling, rising)};
}

// Σdx, Σdy, Σ|dx|, Σ|dy| of a subregion, summed down each of its columns.
struct ColumnSums {
  hn::Vec<F32> dx, dy, abs_dx, abs_dy;

  HWY_INLINE void start() { dx = dy = abs_dx = abs_dy = hn::Zero(F32()); }
  HWY_INLINE void add(const Haar& haar, int row_inside) {
    const F32 d;
    const auto weight = hn::Set(d, kWeights.inside[static_cast<std::size_t>(row_inside)]);
    const auto weighted_dx = hn::Mul(weight, haar.dx), weighted_dy = hn::Mul(weight, haar.dy);
    dx = hn::Add(dx, weighted_dx);
    dy = hn::Add(dy, weighted_dy);
    abs_dx = hn::Add(abs_dx, hn::Abs(weighted_dx));
    abs_dy = hn::Add(abs_dy, hn::Abs(weighted_dy));
  }
  HWY_INLINE void store(float* sums) const { hn::StoreInterleaved4(dx, dy, abs_dx, abs_dy, F32(), sums); }
};

// Sums one vector of columns from `column` on. Each response is computed once: the last rows of a subregion
// are also the first rows of the next. sums[subregion row][column][Σdx, Σdy, Σ|dx|, Σ|dy|]
HWY_INLINE void sum_columns(const Patch& cells, int column, std::array<float, 4 * kColumns>* sums) {
  const float* row = cells.data() + column;
  ColumnSums current, next;
  current.start();
  int k = 0;  // row inside the subregion
  for (int cy = 0; cy < kCells; ++cy) {
    next.start();
    for (; k < kCellStep; ++k, row += kPatchStride) current.add(haar_responses(row), k);
    for (; k < kCellSide; ++k, row += kPatchStride) {
      const Haar haar = haar_responses(row);
      current.add(haar, k);
      next.add(haar, k - kCellStep);
    }
    current.store(sums[cy].data() + 4 * column);
    current = next;
    k -= kCellStep;
  }
}

void SumSubregions(const Patch& cells, Descriptor& descriptor) {
  const Four d4;
  HWY_ALIGN std::array<float, 4 * kColumns> sums[kCells];
  for (int i = 0; i < kResponses; i += static_cast<int>(hn::Lanes(F32()))) sum_columns(cells, i, sums);
  auto squares = hn::Zero(d4);
  for (int cy = 0; cy < kCells; ++cy) {
    for (int cx = 0; cx < kCells; ++cx) {
      auto sum = hn::Zero(d4);
      for (int k = 0; k < kCellSide; ++k) {
        const auto weight = hn::Set(d4, kWeights.inside[static_cast<std::size_t>(k)]);
        sum = hn::Add(sum, hn::Mul(weight, hn::Load(d4, sums[cy].data() + 4 * (cx * kCellStep + k))));
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
