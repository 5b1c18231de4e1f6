#include "vision/integral_image.h"

#include <algorithm>

namespace heel {
namespace {

std::size_t padded_stride(int width_px) {
  const auto columns = static_cast<std::size_t>(width_px + 1 + IntegralImage::kReadablePadding);
  return (columns + 15) / 16 * 16;
}

}  // namespace

IntegralImage::IntegralImage(int max_width_px, int max_height_px) : stride_(padded_stride(max_width_px)) {
  const std::size_t size = stride_ * static_cast<std::size_t>(max_height_px + 1);
  sums_ = hwy::AllocateAligned<std::uint32_t>(size);
  std::fill_n(sums_.get(), size, 0U);  // row 0, column 0 and the padding stay zero
}

void IntegralImage::compute(const FrameView& frame) {
  width_px_ = static_cast<int>(frame.header.width_px);
  height_px_ = static_cast<int>(frame.header.height_px);
  for (int y = 0; y < height_px_; ++y) {
    const std::uint8_t* grey = frame.grey + static_cast<std::size_t>(y) * frame.stride_bytes;
    const std::uint32_t* above = row(y) + 1;
    std::uint32_t* below = sums_.get() + static_cast<std::size_t>(y + 1) * stride_ + 1;
    std::uint32_t row_sum = 0;
    for (int x = 0; x < width_px_; ++x) {
      row_sum += grey[x];
      below[x] = above[x] + row_sum;
    }
  }
}

}  // namespace heel
