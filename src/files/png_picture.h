// PNG files to grey, by libpng.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "files/byte_view.h"

namespace heel {

/// A picture as stored, grey. No bytes: damaged or cut short; `problem` says how.
struct PngPicture {
  std::uint32_t width_px = 0, height_px = 0;
  bool deep = false;  ///< two bytes a value, in this machine's order, with the values of the file; else one
  int significant_bits = 0;         ///< of the values, by the file's sBIT chunk; 0 when it has none
  std::vector<std::uint8_t> bytes;  ///< row-major without gaps
  std::string problem;
  bool has_end = true;  ///< false: the file ends early, but after the last row
};

PngPicture decode_png(ByteView file);

}  // namespace heel
