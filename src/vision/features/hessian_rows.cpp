#include "vision/features/hessian_rows.h"

#include <algorithm>
#include <bit>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vision/features/hessian_rows.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace heel::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using U32 = hn::ScalableTag<std::uint32_t>;
using I32 = hn::ScalableTag<std::int32_t>;
using F32 = hn::ScalableTag<float>;

// The row differences for columns [begin, end):
//   xx: the strip of rows in which the boxes of Dxx lie
//   yy: all rows of the filter, less three times the middle strip
//   xy: the strip above the centre row, less the strip below it
void difference_rows(const IntegralImage& integral, BoxFilter filter, int y, int begin, int end,
                     HessianRowWork& work) {
  const U32 d;
  const int l = filter.lobe, half = filter.half(), mid = (l - 1) / 2;
  const std::uint32_t* strip_top = integral.row(y - l + 1);
  const std::uint32_t* strip_end = integral.row(y + l);
  const std::uint32_t* whole_top = integral.row(y - half);
  const std::uint32_t* whole_end = integral.row(y + half + 1);
  const std::uint32_t* middle_top = integral.row(y - mid);
  const std::uint32_t* middle_end = integral.row(y + mid + 1);
  const std::uint32_t* above_top = integral.row(y - l);
  const std::uint32_t* above_end = integral.row(y);
  const std::uint32_t* below_top = integral.row(y + 1);
  const std::uint32_t* below_end = integral.row(y + l + 1);
  std::uint32_t* xx = work.xx();
  std::uint32_t* yy = work.yy();
  std::uint32_t* xy = work.xy();
  for (int c = begin; c < end; c += static_cast<int>(hn::Lanes(d))) {
    hn::StoreU(hn::Sub(hn::LoadU(d, strip_end + c), hn::LoadU(d, strip_top + c)), d, xx + c);
    const auto whole = hn::Sub(hn::LoadU(d, whole_end + c), hn::LoadU(d, whole_top + c));
    const auto middle = hn::Sub(hn::LoadU(d, middle_end + c), hn::LoadU(d, middle_top + c));
    hn::StoreU(hn::Sub(whole, hn::Add(middle, hn::Add(middle, middle))), d, yy + c);
    const auto above = hn::Sub(hn::LoadU(d, above_end + c), hn::LoadU(d, above_top + c));
    const auto below = hn::Sub(hn::LoadU(d, below_end + c), hn::LoadU(d, below_top + c));
    hn::StoreU(hn::Sub(above, below), d, xy + c);
  }
}

// Every kStep-th column from `columns` on; kStep 0: every `step`-th.
template <int kStep, class D = U32>
HWY_INLINE hn::Vec<D> load_every(const std::uint32_t* columns, int step) {
  const D d;
  const hn::RebindToSigned<D> di;
  if constexpr (kStep == 1) {
    return hn::LoadU(d, columns);
  } else if constexpr (kStep == 2) {
    return hn::ConcatEven(d, hn::LoadU(d, columns + hn::Lanes(d)), hn::LoadU(d, columns));
  } else {
    return hn::GatherIndex(d, columns, hn::Mul(hn::Iota(di, 0), hn::Set(di, step)));
  }
}

// det(H) from its box sums.
template <class D>
HWY_INLINE hn::Vec<D> determinant(D d, BoxFilter filter, hn::Vec<hn::RebindToUnsigned<D>> xx,
                                  hn::Vec<hn::RebindToUnsigned<D>> yy, hn::Vec<hn::RebindToUnsigned<D>> xy) {
  const hn::RebindToSigned<D> di;
  const float area = static_cast<float>(filter.side() * filter.side()) * 255.f;
  const auto dxx = hn::ConvertTo(d, hn::BitCast(di, xx)), dyy = hn::ConvertTo(d, hn::BitCast(di, yy));
  const auto dxy = hn::ConvertTo(d, hn::BitCast(di, xy));
  const auto det = hn::Sub(hn::Mul(dxx, dyy), hn::Mul(hn::Set(d, 0.81f), hn::Mul(dxy, dxy)));
  return hn::Mul(det, hn::Set(d, 1.f / (area * area)));
}

template <int kStep>
void response_row(HessianRowWork& work, BoxFilter filter, int step, int first, int last, float* response) {
  const F32 d;
  const int l = filter.lobe, half = filter.half(), mid = (l - 1) / 2;
  for (int i = first; i < last; i += static_cast<int>(hn::Lanes(d))) {
    const std::uint32_t* xx = work.xx() + i * step;
    const std::uint32_t* yy = work.yy() + i * step;
    const std::uint32_t* xy = work.xy() + i * step;
    const auto whole = hn::Sub(load_every<kStep>(xx + half + 1, step), load_every<kStep>(xx - half, step));
    const auto middle = hn::Sub(load_every<kStep>(xx + mid + 1, step), load_every<kStep>(xx - mid, step));
    const auto dxx = hn::Sub(whole, hn::Add(middle, hn::Add(middle, middle)));
    const auto dyy = hn::Sub(load_every<kStep>(yy + l, step), load_every<kStep>(yy - l + 1, step));
    const auto left = hn::Sub(load_every<kStep>(xy, step), load_every<kStep>(xy - l, step));
    const auto right = hn::Sub(load_every<kStep>(xy + l + 1, step), load_every<kStep>(xy + 1, step));
    hn::StoreU(determinant(d, filter, dxx, dyy, hn::Sub(left, right)), d, response + i);
  }
}

void HessianResponseRow(const IntegralImage& integral, BoxFilter filter, int y, int step, int first, int last,
                        HessianRowWork& work, float* response) {
  difference_rows(integral, filter, y, first * step - filter.half(), (last - 1) * step + filter.half() + 2,
                  work);
  switch (step) {
    case 1:
      return response_row<1>(work, filter, step, first, last, response);
    case 2:
      return response_row<2>(work, filter, step, first, last, response);
    default:
      return response_row<0>(work, filter, step, first, last, response);
  }
}

// One row of the patch, directly from the integral image: three samples, and a fourth in the last lane that
// is not used.
template <int kStep>
HWY_INLINE hn::Vec<hn::FixedTag<float, 4>> patch_row(const IntegralImage& integral, BoxFilter filter, int x,
                                                     int y, int step) {
  using U4 = hn::FixedTag<std::uint32_t, 4>;
  const int l = filter.lobe, half = filter.half(), mid = (l - 1) / 2;
  // The box of rows [y + top, y + bottom) and columns [x + left, x + right).
  const auto box = [&](int top, int bottom, int left, int right) {
    const std::uint32_t* above = integral.row(y + top) + x;
    const std::uint32_t* below = integral.row(y + bottom) + x;
    return hn::Sub(
        hn::Sub(load_every<kStep, U4>(below + right, step), load_every<kStep, U4>(below + left, step)),
        hn::Sub(load_every<kStep, U4>(above + right, step), load_every<kStep, U4>(above + left, step)));
  };
  const auto less_three = [](hn::Vec<U4> whole, hn::Vec<U4> middle) {
    return hn::Sub(whole, hn::Add(middle, hn::Add(middle, middle)));
  };
  const auto xx = less_three(box(1 - l, l, -half, half + 1), box(1 - l, l, -mid, mid + 1));
  const auto yy = less_three(box(-half, half + 1, 1 - l, l), box(-mid, mid + 1, 1 - l, l));
  const auto falling = hn::Add(box(-l, 0, -l, 0), box(1, l + 1, 1, l + 1));
  const auto rising = hn::Add(box(-l, 0, 1, l + 1), box(1, l + 1, -l, 0));
  return determinant(hn::FixedTag<float, 4>(), filter, xx, yy, hn::Sub(falling, rising));
}

template <int kStep>
HWY_INLINE bool patch_rows(const IntegralImage& integral, BoxFilter filter, int x, int y, int step,
                           float limit, ResponsePatch& patch) {
  const hn::FixedTag<float, 4> d;
  const auto three = hn::FirstN(d, 3);
  const auto limits = hn::Set(d, limit);
  HWY_ALIGN float row[4];
  for (const int j : {1, 0, 2}) {  // the middle row first: it exceeds the limit most often
    const auto responses = patch_row<kStep>(integral, filter, x - step, y + (j - 1) * step, step);
    if (!hn::AllFalse(d, hn::And(three, hn::Gt(responses, limits)))) return false;
    hn::Store(responses, d, row);
    std::copy_n(row, 3, patch[static_cast<std::size_t>(j)].data());
  }
  return true;
}

bool HessianResponsePatch(const IntegralImage& integral, BoxFilter filter, int x, int y, int step,
                          float limit, ResponsePatch& patch) {
  switch (step) {
    case 1:
      return patch_rows<1>(integral, filter, x, y, step, limit, patch);
    case 2:
      return patch_rows<2>(integral, filter, x, y, step, limit, patch);
    default:
      return patch_rows<0>(integral, filter, x, y, step, limit, patch);
  }
}

HWY_INLINE hn::Vec<F32> max_of_three(const float* row, int i) {
  const F32 d;
  return hn::Max(hn::LoadU(d, row + i), hn::Max(hn::LoadU(d, row + i - 1), hn::LoadU(d, row + i + 1)));
}

HWY_INLINE hn::Vec<F32> max_of_nine(const LayerRows& rows, int i) {
  return hn::Max(max_of_three(rows[1], i), hn::Max(max_of_three(rows[0], i), max_of_three(rows[2], i)));
}

// Which of the Lanes samples from i on are maxima above `floor`. The cheapest comparisons come first, since
// few samples pass them.
HWY_INLINE hn::Mask<F32> maxima_mask(const LayerRows& own, std::span<const LayerRows> others, int i,
                                     hn::Vec<F32> floor) {
  const F32 d;
  const auto centre = hn::LoadU(d, own[1] + i);
  const auto beside = hn::Max(hn::LoadU(d, own[1] + i - 1), hn::LoadU(d, own[1] + i + 1));
  const auto cross = hn::Max(beside, hn::Max(hn::LoadU(d, own[0] + i), hn::LoadU(d, own[2] + i)));
  auto is_max = hn::And(hn::Gt(centre, floor), hn::Ge(centre, cross));
  if (hn::AllFalse(d, is_max)) return is_max;
  is_max = hn::And(is_max, hn::Ge(centre, hn::Max(max_of_three(own[0], i), max_of_three(own[2], i))));
  for (const LayerRows& other : others) {
    if (hn::AllFalse(d, is_max)) return is_max;
    is_max = hn::And(is_max, hn::Ge(centre, max_of_nine(other, i)));
  }
  return is_max;
}

int FindMaximaRow(const LayerRows& own, std::span<const LayerRows> others, int first, int last,
                  float threshold, std::int32_t* maxima) {
  const F32 d;
  int count = 0;
  const auto floor = hn::Set(d, threshold);
  for (int i = first; i < last; i += static_cast<int>(hn::Lanes(d))) {
    const auto is_max = maxima_mask(own, others, i, floor);
    if (hn::AllFalse(d, is_max)) continue;
    // There are few maxima; they are written one by one, since a masked store is slow on many processors.
    std::uint64_t bits = 0;
    hn::StoreMaskBits(d, is_max, reinterpret_cast<std::uint8_t*>(&bits));
    for (; bits != 0; bits &= bits - 1) {
      const int k = i + std::countr_zero(bits);
      if (k < last) maxima[count++] = k;
    }
  }
  return count;
}

}  // namespace
}  // namespace heel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heel {

HWY_EXPORT(HessianResponseRow);
HWY_EXPORT(HessianResponsePatch);
HWY_EXPORT(FindMaximaRow);

HessianRowWork::HessianRowWork(int max_width_px)
    : size_(static_cast<std::size_t>(max_width_px + 1 + IntegralImage::kReadablePadding)),
      columns_(hwy::AllocateAligned<std::uint32_t>(3 * size_ + IntegralImage::kReadablePadding)) {
  std::fill_n(columns_.get(), 3 * size_ + IntegralImage::kReadablePadding, 0U);
}

void hessian_response_row(const IntegralImage& integral, BoxFilter filter, int y, int step, int first,
                          int last, HessianRowWork& work, float* response) {
  HWY_DYNAMIC_DISPATCH(HessianResponseRow)(integral, filter, y, step, first, last, work, response);
}

bool hessian_response_patch(const IntegralImage& integral, BoxFilter filter, int x, int y, int step,
                            float limit, ResponsePatch& patch) {
  return HWY_DYNAMIC_DISPATCH(HessianResponsePatch)(integral, filter, x, y, step, limit, patch);
}

int find_maxima_row(const LayerRows& own, std::span<const LayerRows> others, int first, int last,
                    float threshold, std::int32_t* maxima) {
  return HWY_DYNAMIC_DISPATCH(FindMaximaRow)(own, others, first, last, threshold, maxima);
}

std::int8_t laplacian_sign(const IntegralImage& integral, BoxFilter filter, int x, int y) {
  const int l = filter.lobe, half = filter.half(), mid = (l - 1) / 2;
  const auto box = [&](int x0, int y0, int x1, int y1) {
    return static_cast<std::int32_t>(integral.row(y1)[x1] - integral.row(y1)[x0] - integral.row(y0)[x1] +
                                     integral.row(y0)[x0]);
  };
  const int dxx =
      box(x - half, y - l + 1, x + half + 1, y + l) - 3 * box(x - mid, y - l + 1, x + mid + 1, y + l);
  const int dyy =
      box(x - l + 1, y - half, x + l, y + half + 1) - 3 * box(x - l + 1, y - mid, x + l, y + mid + 1);
  return dxx + dyy >= 0 ? std::int8_t{1} : std::int8_t{-1};
}

}  // namespace heel
#endif  // HWY_ONCE
