// An image at half its size: what a camera would see of a flat scene from twice the distance.
//
// Convention: row-major grey levels. Units: pixels.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace heel {

struct HalfSizeImage {
  std::vector<std::uint8_t> grey;  ///< row-major, without padding
  int width_px = 0;
  int height_px = 0;
};

/// Every pixel is the mean of 2 × 2 pixels of `grey` (row-major, width_px × height_px), halves rounded up.
/// For even sizes the result equals cv::resize with INTER_AREA to the bit. An odd last column or row is left
/// out.
HalfSizeImage half_size(std::span<const std::uint8_t> grey, int width_px, int height_px);

}  // namespace heel
