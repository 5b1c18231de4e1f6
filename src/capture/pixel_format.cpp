#include "capture/pixel_format.h"

namespace heel {

const char* to_string(PixelFormat format) {
  switch (format) {
    case PixelFormat::Grey:
      return "GREY";
    case PixelFormat::Nv12:
      return "NV12";
    case PixelFormat::Yuyv:
      return "YUYV";
    case PixelFormat::Mjpg:
      return "MJPG";
  }
  return "?";
}

bool parse_pixel_format(const std::string& name, PixelFormat& format) {
  for (const PixelFormat known :
       {PixelFormat::Grey, PixelFormat::Nv12, PixelFormat::Yuyv, PixelFormat::Mjpg}) {
    if (name != to_string(known)) continue;
    format = known;
    return true;
  }
  return false;
}

std::uint32_t row_bytes(PixelFormat format, std::uint32_t width_px) {
  switch (format) {
    case PixelFormat::Grey:
    case PixelFormat::Nv12:
      return width_px;
    case PixelFormat::Yuyv:
      return 2 * width_px;
    case PixelFormat::Mjpg:
      break;
  }
  return 0;
}

std::size_t luma_bytes_needed(PixelFormat format, std::uint32_t width_px, std::uint32_t height_px,
                              std::uint32_t stride_bytes) {
  if (format == PixelFormat::Mjpg || height_px == 0) return 0;
  // The last row need not be padded to the stride.
  return std::size_t{stride_bytes} * (height_px - 1) + row_bytes(format, width_px);
}

void grey_from_yuyv(const std::uint8_t* yuyv, std::uint32_t stride_bytes, std::uint32_t width_px,
                    std::uint32_t height_px, std::uint8_t* grey) {
  for (std::uint32_t y = 0; y < height_px; ++y) {
    const std::uint8_t* row = yuyv + std::size_t{y} * stride_bytes;
    std::uint8_t* out = grey + std::size_t{y} * width_px;
    for (std::uint32_t x = 0; x < width_px; ++x) out[x] = row[2 * x];
  }
}

}  // namespace heel
