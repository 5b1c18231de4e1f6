// Frames as JPEG, by libjpeg, for the page.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "heel/flow.h"

namespace heel {

/// A frame that owns its pixels, without gaps.
struct KeptFrame {
  FrameHeader header;
  std::vector<std::uint8_t> grey;
};

/// Empty when libjpeg refuses it. `quality` is 1 to 100.
std::string jpeg_of(const KeptFrame& frame, int quality);

}  // namespace heel
