#include "vision/template/half_size.h"

#include <cstddef>

namespace heel {

HalfSizeImage half_size(std::span<const std::uint8_t> grey, int width_px, int height_px) {
  HalfSizeImage half;
  half.width_px = width_px / 2;
  half.height_px = height_px / 2;
  half.grey.reserve(static_cast<std::size_t>(half.width_px) * static_cast<std::size_t>(half.height_px));
  const auto stride = static_cast<std::size_t>(width_px);
  for (int y_px = 0; y_px < half.height_px; ++y_px) {
    const std::uint8_t* upper = &grey[2 * static_cast<std::size_t>(y_px) * stride];
    const std::uint8_t* lower = upper + stride;
    for (int x_px = 0; x_px < half.width_px; ++x_px, upper += 2, lower += 2) {
      half.grey.push_back(static_cast<std::uint8_t>((upper[0] + upper[1] + lower[0] + lower[1] + 2) / 4));
    }
  }
  return half;
}

}  // namespace heel
