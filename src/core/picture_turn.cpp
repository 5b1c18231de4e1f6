#include "core/picture_turn.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace heel {
namespace {

// Both pictures are walked in squares that fit into the cache: one of them is read or written by columns.
constexpr std::uint32_t kSquare_px = 32;

}  // namespace

void turn_grey(const PictureTurn& turn, const std::uint8_t* grey, std::uint32_t stride_bytes,
               std::uint32_t width_px, std::uint32_t height_px, std::uint8_t* turned) {
  const auto width = static_cast<std::ptrdiff_t>(width_px);
  const auto height = static_cast<std::ptrdiff_t>(height_px);
  // Where the first pixel goes, and how far apart neighbours of a row and of a column are there.
  std::ptrdiff_t first = 0, along_row = 1, along_column = width;
  switch (turn.quarters) {
    case 1:
      first = height - 1, along_row = height, along_column = -1;
      break;
    case 2:
      first = width * height - 1, along_row = -1, along_column = -width;
      break;
    case 3:
      first = (width - 1) * height, along_row = -height, along_column = 1;
      break;
    default:
      break;
  }
  if (turn.mirror) {
    first += (width - 1) * along_row;
    along_row = -along_row;
  }
  for (std::uint32_t y0 = 0; y0 < height_px; y0 += kSquare_px) {
    for (std::uint32_t x0 = 0; x0 < width_px; x0 += kSquare_px) {
      for (std::uint32_t y = y0; y < std::min(y0 + kSquare_px, height_px); ++y) {
        const std::uint8_t* from = grey + std::size_t{y} * stride_bytes + x0;
        std::uint8_t* to = turned + first + static_cast<std::ptrdiff_t>(y) * along_column +
                           static_cast<std::ptrdiff_t>(x0) * along_row;
        for (std::uint32_t x = x0; x < std::min(x0 + kSquare_px, width_px); ++x, to += along_row)
          *to = *from++;
      }
    }
  }
}

void PictureTurner::reserve(std::uint32_t width_px, std::uint32_t height_px) {
  const std::size_t pixels = std::size_t{width_px} * height_px;
  if (turn_.any() && turned_.size() < pixels) turned_.resize(pixels);
}

FrameView PictureTurner::of(const FrameView& frame) {
  if (!turn_.any()) return frame;
  FrameView turned = frame;
  FrameHeader& header = turned.header;
  reserve(header.width_px, header.height_px);
  turn_grey(turn_, frame.grey, frame.stride_bytes, header.width_px, header.height_px, turned_.data());
  if (turn_.swaps_sides()) std::swap(header.width_px, header.height_px);
  turned.grey = turned_.data();
  turned.stride_bytes = header.width_px;
  return turned;
}

}  // namespace heel
