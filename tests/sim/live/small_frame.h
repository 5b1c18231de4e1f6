// A frame of 4 × 2 pixels.
#pragma once

#include <cstdint>
#include <vector>

#include "heel/flow.h"

namespace heel::test {

/// The view of `grey`, eight bytes, which must outlive it.
inline FrameView small_frame(const std::vector<std::uint8_t>& grey) {
  FrameView frame;
  frame.header.width_px = frame.stride_bytes = 4;
  frame.header.height_px = 2;
  frame.grey = grey.data();
  return frame;
}

}  // namespace heel::test
