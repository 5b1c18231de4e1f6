#include "vision/features/integral_image.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vision/features/integral_image.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace heel::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using U16 = hn::FixedTag<std::uint16_t, 8>;
using U32 = hn::FixedTag<std::uint32_t, 4>;

// Sums of the first 1, 2, … 8 lanes: the three steps add the lane 1, 2 and 4 places before.
HWY_INLINE hn::Vec<U16> running_sums(hn::Vec<U16> v) {
  const U16 d;
  v = hn::Add(v, hn::ShiftLeftLanes<1>(d, v));
  v = hn::Add(v, hn::ShiftLeftLanes<2>(d, v));
  return hn::Add(v, hn::ShiftLeftLanes<4>(d, v));
}

// below[x] = above[x] + grey[0] + … + grey[x], eight pixels at a time; the sum of eight fits 16 bits.
void IntegralRow(const std::uint8_t* grey, const std::uint32_t* above, std::uint32_t* below, int width_px) {
  const hn::FixedTag<std::uint8_t, 8> d8;
  const U16 d16;
  const U32 d32;
  auto before = hn::Zero(d32);  // the row's sum so far, in every lane
  int x = 0;
  for (; x + 8 <= width_px; x += 8) {
    const auto sums = running_sums(hn::PromoteTo(d16, hn::LoadU(d8, grey + x)));
    const auto low = hn::Add(before, hn::PromoteTo(d32, hn::LowerHalf(sums)));
    const auto high = hn::Add(before, hn::PromoteTo(d32, hn::UpperHalf(hn::Half<U16>(), sums)));
    hn::StoreU(hn::Add(low, hn::LoadU(d32, above + x)), d32, below + x);
    hn::StoreU(hn::Add(high, hn::LoadU(d32, above + x + 4)), d32, below + x + 4);
    before = hn::Broadcast<3>(high);
  }
  std::uint32_t row_sum = hn::GetLane(before);
  for (; x < width_px; ++x) {
    row_sum += grey[x];
    below[x] = above[x] + row_sum;
  }
}

}  // namespace
}  // namespace heel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heel {
namespace {

std::size_t padded_stride(int width_px) {
  const auto columns = static_cast<std::size_t>(width_px + 1 + IntegralImage::kReadablePadding);
  return (columns + 15) / 16 * 16;
}

}  // namespace

HWY_EXPORT(IntegralRow);

IntegralImage::IntegralImage(int max_width_px, int max_height_px) : stride_(padded_stride(max_width_px)) {
  const std::size_t size = stride_ * static_cast<std::size_t>(max_height_px + 1);
  sums_ = hwy::AllocateAligned<std::uint32_t>(size);
  std::fill_n(sums_.get(), size, 0U);  // row 0, column 0 and the padding stay zero
}

void IntegralImage::compute(const FrameView& frame) {
  compute(frame, {0, 0, static_cast<int>(frame.header.width_px), static_cast<int>(frame.header.height_px)});
}

void IntegralImage::compute(const FrameView& frame, const Region& part) {
  width_px_ = static_cast<int>(frame.header.width_px);
  height_px_ = static_cast<int>(frame.header.height_px);
  const auto first = static_cast<std::size_t>(part.x_px);
  std::uint32_t* above = sums_.get() + static_cast<std::size_t>(part.y_px) * stride_ + first;
  const std::uint8_t* grey = frame.grey + static_cast<std::size_t>(part.y_px) * frame.stride_bytes + first;
  std::fill_n(above, part.width_px + 1, 0U);
  for (int y = 0; y < part.height_px; ++y, above += stride_, grey += frame.stride_bytes) {
    std::uint32_t* const below = above + stride_;
    below[0] = 0;
    HWY_DYNAMIC_DISPATCH(IntegralRow)(grey, above + 1, below + 1, part.width_px);
  }
}

}  // namespace heel
#endif  // HWY_ONCE
