#include "vision/box_grid.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vision/box_grid.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace heel::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using F32 = hn::CappedTag<float, 16>;
using I32 = hn::RebindToSigned<F32>;
using U32 = hn::RebindToUnsigned<F32>;

// A coordinate of the integral image as the line before it and how far beyond that it lies.
struct Lines {
  hn::Vec<I32> index;
  hn::Vec<F32> fraction;
};

HWY_INLINE Lines split(hn::Vec<F32> coordinate, int size_px) {
  const F32 d;
  const I32 di;
  const auto floor = hn::ConvertTo(di, hn::Floor(coordinate));
  const auto index = hn::Min(hn::Max(floor, hn::Zero(di)), hn::Set(di, size_px - 1));
  return {index, hn::Sub(coordinate, hn::ConvertTo(d, index))};
}

HWY_INLINE hn::Vec<F32> difference(hn::Vec<U32> a, hn::Vec<U32> b) {
  return hn::ConvertTo(F32(), hn::BitCast(I32(), hn::Sub(a, b)));
}

HWY_INLINE hn::Vec<F32> lerp(hn::Vec<F32> a, hn::Vec<F32> b, hn::Vec<F32> t) {
  return hn::Add(a, hn::Mul(t, hn::Sub(b, a)));
}

void SampleUprightGrid(const IntegralImage& integral, float x_px, float y_px, float spacing_px, int lines,
                       Patch& grid) {
  const F32 d;
  const float first = -0.5f * static_cast<float>(lines - 1);
  const float x0 = x_px + 0.5f, y0 = y_px + 0.5f;  // pixel centres in the integral image
  const int base_y = std::min(std::max(static_cast<int>(y0), 0), integral.height_px());
  const std::uint32_t* base = integral.row(base_y);
  const std::size_t base_x =
      static_cast<std::size_t>(std::min(std::max(static_cast<int>(x0), 0), integral.width_px()));
  for (int i = 0; i < lines; i += static_cast<int>(hn::Lanes(d))) {
    const auto step = hn::Add(hn::Iota(d, static_cast<float>(i)), hn::Set(d, first));
    const Lines x =
        split(hn::Add(hn::Set(d, x0), hn::Mul(step, hn::Set(d, spacing_px))), integral.width_px());
    const auto base_left = hn::GatherIndex(U32(), base, x.index);
    const auto base_right = hn::GatherIndex(U32(), base + 1, x.index);
    for (int j = 0; j < lines; ++j) {
      const float y = y0 + (first + static_cast<float>(j)) * spacing_px;
      const float y_floor = std::floor(y);
      const int row = std::min(std::max(static_cast<int>(y_floor), 0), integral.height_px() - 1);
      const std::uint32_t* upper = integral.row(row);
      const std::uint32_t* lower = integral.row(row + 1);
      const auto at = [&](const std::uint32_t* line, std::size_t offset, hn::Vec<U32> base_value) {
        const auto origin = hn::Set(U32(), line[base_x] - base[base_x]);
        return difference(hn::Sub(hn::GatherIndex(U32(), line + offset, x.index), base_value), origin);
      };
      const auto top = lerp(at(upper, 0, base_left), at(upper, 1, base_right), x.fraction);
      const auto bottom = lerp(at(lower, 0, base_left), at(lower, 1, base_right), x.fraction);
      hn::StoreU(lerp(top, bottom, hn::Set(d, y - static_cast<float>(row))), d,
                 grid.data() + j * kPatchStride + i);
    }
  }
}

void SampleUprightCells(const IntegralImage& integral, float x_px, float y_px, float spacing_px,
                        Patch& cells) {
  const F32 d;
  SampleUprightGrid(integral, x_px, y_px, spacing_px, kGridLines, cells);
  for (int j = 0; j < kPatchCells; ++j) {
    float* row = cells.data() + j * kPatchStride;
    for (int i = 0; i < kPatchCells; i += static_cast<int>(hn::Lanes(d))) {
      const auto strip = [&](int column) {
        return hn::Sub(hn::LoadU(d, row + 2 * kPatchStride + column), hn::LoadU(d, row + column));
      };
      hn::StoreU(hn::Sub(strip(i + 2), strip(i)), d, row + i);
    }
  }
}

void SampleRotatedCells(const IntegralImage& integral, float x_px, float y_px, float spacing_px,
                        float cos_angle, float sin_angle, Patch& cells) {
  const F32 d;
  const U32 du;
  const I32 di;
  const int middle = kPatchCells / 2;
  const auto half = hn::Set(d, spacing_px);
  const auto stride = hn::Set(di, static_cast<std::int32_t>(integral.stride()));
  const std::uint32_t* origin = integral.row(0);
  for (int j = 0; j < kPatchCells; ++j) {
    const float v = static_cast<float>(j - middle) * spacing_px;
    for (int i = 0; i < kPatchCells; i += static_cast<int>(hn::Lanes(d))) {
      const auto u = hn::Mul(hn::Iota(d, static_cast<float>(i - middle)), hn::Set(d, spacing_px));
      const auto x = hn::Add(hn::Set(d, x_px + 0.5f - sin_angle * v), hn::Mul(hn::Set(d, cos_angle), u));
      const auto y = hn::Add(hn::Set(d, y_px + 0.5f + cos_angle * v), hn::Mul(hn::Set(d, sin_angle), u));
      const Lines left = split(hn::Sub(x, half), integral.width_px());
      const Lines right = split(hn::Add(x, half), integral.width_px());
      const Lines top = split(hn::Sub(y, half), integral.height_px());
      const Lines bottom = split(hn::Add(y, half), integral.height_px());
      // Everything above one line of the integral image, between the box's left and right.
      const auto strip = [&](hn::Vec<I32> line) {
        const auto start = hn::Mul(line, stride);
        const auto at = [&](hn::Vec<I32> column, std::size_t offset) {
          return hn::GatherIndex(du, origin + offset, hn::Add(start, column));
        };
        const auto l0 = at(left.index, 0), l1 = at(left.index, 1);
        const auto r0 = at(right.index, 0), r1 = at(right.index, 1);
        return hn::Add(difference(r0, l0), hn::Sub(hn::Mul(right.fraction, difference(r1, r0)),
                                                   hn::Mul(left.fraction, difference(l1, l0))));
      };
      const auto one = hn::Set(di, 1);
      const auto above = lerp(strip(top.index), strip(hn::Add(top.index, one)), top.fraction);
      const auto below = lerp(strip(bottom.index), strip(hn::Add(bottom.index, one)), bottom.fraction);
      hn::StoreU(hn::Sub(below, above), d, cells.data() + j * kPatchStride + i);
    }
  }
}

}  // namespace
}  // namespace heel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heel {

HWY_EXPORT(SampleUprightGrid);
HWY_EXPORT(SampleUprightCells);
HWY_EXPORT(SampleRotatedCells);

void sample_upright_grid(const IntegralImage& integral, float x_px, float y_px, float spacing_px, int lines,
                         Patch& grid) {
  HWY_DYNAMIC_DISPATCH(SampleUprightGrid)(integral, x_px, y_px, spacing_px, lines, grid);
}

void sample_upright_cells(const IntegralImage& integral, float x_px, float y_px, float spacing_px,
                          Patch& cells) {
  HWY_DYNAMIC_DISPATCH(SampleUprightCells)(integral, x_px, y_px, spacing_px, cells);
}

void sample_rotated_cells(const IntegralImage& integral, float x_px, float y_px, float spacing_px,
                          float cos_angle, float sin_angle, Patch& cells) {
  HWY_DYNAMIC_DISPATCH(SampleRotatedCells)(integral, x_px, y_px, spacing_px, cos_angle, sin_angle, cells);
}

}  // namespace heel
#endif  // HWY_ONCE
