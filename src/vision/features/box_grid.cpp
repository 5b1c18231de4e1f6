#include "vision/features/box_grid.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vision/features/box_grid.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace heel::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using F32 = hn::CappedTag<float, 16>;
using I32 = hn::RebindToSigned<F32>;
using U32 = hn::RebindToUnsigned<F32>;

// Coordinates of the integral image: the line before each, and the fraction of a line beyond it.
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

using F4 = hn::FixedTag<float, 4>;
using I4 = hn::RebindToSigned<F4>;
using U4 = hn::RebindToUnsigned<F4>;

// Where the columns of an upright grid lie in the integral image, four at a time: the index of the column
// before each grid line, and the fraction of a column beyond it.
struct GridColumns {
  static constexpr int kPadded = (kGridLines + 3) / 4 * 4;
  HWY_ALIGN std::array<std::int32_t, kPadded> index;
  HWY_ALIGN std::array<float, kPadded> fraction;

  // How many columns of the image lie between the first grid line and the last that is computed.
  int span(int lines) const {
    return index[static_cast<std::size_t>((lines + 3) / 4 * 4 - 1)] + 2 - index[0];
  }
};

// The sums left and right of each of two grid lines. One 64-bit read for each grid line replaces two reads of
// a gather.
template <class T>
HWY_INLINE hn::Vec<hn::FixedTag<T, 4>> load_pairs(const T* low, const T* high) {
  const hn::FixedTag<T, 2> d2;
  return hn::Combine(hn::FixedTag<T, 4>(), hn::LoadU(d2, high), hn::LoadU(d2, low));
}

void place_columns(const IntegralImage& integral, float x0, float first, float spacing_px,
                   GridColumns& columns) {
  const F4 d;
  const I4 di;
  for (int i = 0; i < GridColumns::kPadded; i += 4) {
    const auto step = hn::Add(hn::Iota(d, static_cast<float>(i)), hn::Set(d, first));
    const auto x = hn::Add(hn::Set(d, x0), hn::Mul(step, hn::Set(d, spacing_px)));
    const auto index =
        hn::Min(hn::Max(hn::ConvertTo(di, hn::Floor(x)), hn::Zero(di)), hn::Set(di, integral.width_px() - 1));
    hn::Store(index, di, columns.index.data() + i);
    hn::Store(hn::Sub(x, hn::ConvertTo(d, index)), d, columns.fraction.data() + i);
  }
}

// One grid line between two rows of the integral image. Sums are relative to the grid's centre.
struct GridLine {
  const std::uint32_t *upper, *lower;
  std::uint32_t upper_origin, lower_origin;
  float down;  // from the upper row to the lower one

  // The sums at columns of the image, of which both rows and the base row are given.
  template <class D>
  HWY_INLINE hn::Vec<D> blend(D d, hn::Vec<hn::RebindToUnsigned<D>> above,
                              hn::Vec<hn::RebindToUnsigned<D>> below,
                              hn::Vec<hn::RebindToUnsigned<D>> base) const {
    const hn::RebindToUnsigned<D> du;
    const auto at = [&](auto sums, std::uint32_t origin) {
      const auto relative = hn::Sub(hn::Sub(sums, base), hn::Set(du, origin));
      return hn::ConvertTo(d, hn::BitCast(hn::RebindToSigned<D>(), relative));
    };
    const auto top = at(above, upper_origin);
    return hn::Add(top, hn::Mul(hn::Set(d, down), hn::Sub(at(below, lower_origin), top)));
  }
};

// Where the lines of an upright grid lie in the integral image. Sums are relative to those of the base row.
struct GridRows {
  int lines;
  const std::uint32_t* base;
  std::array<GridLine, kGridLines> line;
};

void place_rows(const IntegralImage& integral, float x0, float y0, float first, float spacing_px,
                GridRows& rows) {
  const int base_x = std::min(std::max(static_cast<int>(x0), 0), integral.width_px());
  const int base_y = std::min(std::max(static_cast<int>(y0), 0), integral.height_px());
  rows.base = integral.row(base_y);
  for (int j = 0; j < rows.lines; ++j) {
    const float y = y0 + (first + static_cast<float>(j)) * spacing_px;
    const int row = std::min(std::max(static_cast<int>(std::floor(y)), 0), integral.height_px() - 1);
    const std::uint32_t *upper = integral.row(row), *lower = integral.row(row + 1);
    rows.line[static_cast<std::size_t>(j)] = {upper, lower, upper[base_x] - rows.base[base_x],
                                              lower[base_x] - rows.base[base_x], y - static_cast<float>(row)};
  }
}

// Four points of the grid, from the sums left and right of each, alternating.
HWY_INLINE void store_across(hn::Vec<F4> low, hn::Vec<F4> high, const float* fraction, float* out) {
  const F4 d;
  const auto left = hn::ConcatEven(d, high, low), right = hn::ConcatOdd(d, high, low);
  hn::StoreU(hn::Add(left, hn::Mul(hn::Load(d, fraction), hn::Sub(right, left))), d, out);
}

// A narrow grid: all columns of the image that it spans are blended between rows, many at a time, and then
// each grid line takes the two beside it.
constexpr int kNarrow = 11 * static_cast<int>(hn::MaxLanes(F32()));

HWY_INLINE void sample_narrow(const GridRows& rows, const GridColumns& columns, Patch& grid) {
  const F32 d;
  const U32 du;
  const int n = static_cast<int>(hn::Lanes(d));
  const int begin = columns.index[0] / n * n, end = columns.index[0] + columns.span(rows.lines);
  // Filled as far as it is read. NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init)
  HWY_ALIGN std::array<float, static_cast<std::size_t>(kGridLines) * kNarrow> blended;
  for (int x = begin; x < end; x += n) {
    const auto base = hn::Load(du, rows.base + x);
    float* out = blended.data() + (x - begin);
    for (int j = 0; j < rows.lines; ++j, out += kNarrow) {
      const GridLine& line = rows.line[static_cast<std::size_t>(j)];
      hn::Store(line.blend(d, hn::Load(du, line.upper + x), hn::Load(du, line.lower + x), base), d, out);
    }
  }
  for (int i = 0; i < rows.lines; i += 4) {
    const std::int32_t* index = columns.index.data() + i;
    const std::ptrdiff_t x0 = index[0] - begin, x1 = index[1] - begin, x2 = index[2] - begin,
                         x3 = index[3] - begin;
    const float* row = blended.data();
    for (int j = 0; j < rows.lines; ++j, row += kNarrow)
      store_across(load_pairs(row + x0, row + x1), load_pairs(row + x2, row + x3),
                   columns.fraction.data() + i, grid.data() + j * kPatchStride + i);
  }
}

// A wide grid: only the columns beside its lines are read.
HWY_INLINE void sample_wide(const GridRows& rows, const GridColumns& columns, Patch& grid) {
  for (int i = 0; i < rows.lines; i += 4) {
    const std::int32_t* x = columns.index.data() + i;
    const auto base_low = load_pairs(rows.base + x[0], rows.base + x[1]);
    const auto base_high = load_pairs(rows.base + x[2], rows.base + x[3]);
    for (int j = 0; j < rows.lines; ++j) {
      const GridLine& line = rows.line[static_cast<std::size_t>(j)];
      const auto pairs = [&](int first, int second, hn::Vec<U4> base) {
        return line.blend(F4(), load_pairs(line.upper + first, line.upper + second),
                          load_pairs(line.lower + first, line.lower + second), base);
      };
      store_across(pairs(x[0], x[1], base_low), pairs(x[2], x[3], base_high), columns.fraction.data() + i,
                   grid.data() + j * kPatchStride + i);
    }
  }
}

void SampleUprightGrid(const IntegralImage& integral, float x_px, float y_px, float spacing_px, int lines,
                       Patch& grid) {
  const float first = -0.5f * static_cast<float>(lines - 1);
  const float x0 = x_px + 0.5f, y0 = y_px + 0.5f;  // pixel centres in the integral image
  // Filled at once: clearing them would cost time. NOLINTBEGIN(cppcoreguidelines-pro-type-member-init)
  GridRows rows;
  GridColumns columns;
  // NOLINTEND(cppcoreguidelines-pro-type-member-init)
  rows.lines = lines;
  place_rows(integral, x0, y0, first, spacing_px, rows);
  place_columns(integral, x0, first, spacing_px, columns);
  if (columns.span(lines) <= kNarrow - static_cast<int>(hn::Lanes(F32())))
    sample_narrow(rows, columns, grid);
  else
    sample_wide(rows, columns, grid);
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
      // The sum above one line of the integral image, between the left and right sides of the box.
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
