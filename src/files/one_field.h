// Interlaced pictures: two fields of different times, row by row in turn. One field is used.
#pragma once

#include <cstddef>
#include <cstdint>

namespace heel {

/// Replaces the rows 1, 3, … by the mean of those above and below.
inline void keep_one_field(std::uint8_t* grey, std::uint32_t width_px, std::uint32_t height_px,
                           std::size_t stride_bytes) {
  for (std::uint32_t y = 1; y < height_px; y += 2) {
    std::uint8_t* const row = grey + y * stride_bytes;
    const std::uint8_t* const above = row - stride_bytes;
    const std::uint8_t* const below = y + 1 < height_px ? row + stride_bytes : above;
    for (std::uint32_t x = 0; x < width_px; ++x)
      row[x] = static_cast<std::uint8_t>((above[x] + below[x] + 1) / 2);
  }
}

}  // namespace heel
