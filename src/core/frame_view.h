// Pixels in memory as a frame.
#pragma once

#include <cstdint>

#include "heel/flow.h"

namespace heel {

/// A frame without number and time, of pixels without gaps between rows; valid as long as they are.
inline FrameView packed_frame(const std::uint8_t* grey, int width_px, int height_px) {
  FrameView frame;
  frame.header.width_px = static_cast<std::uint32_t>(width_px);
  frame.header.height_px = static_cast<std::uint32_t>(height_px);
  frame.grey = grey;
  frame.stride_bytes = frame.header.width_px;
  return frame;
}

}  // namespace heel
