#include "capture/pixel_format.h"

#include <array>

namespace heel {
namespace {

constexpr std::array kFormats{PixelFormat::Grey, PixelFormat::Nv12, PixelFormat::Yuyv,
                              PixelFormat::Rgb3, PixelFormat::Bgr3, PixelFormat::Mjpg};

void grey_from_yuyv(const std::uint8_t* row, std::uint32_t width_px, std::uint8_t* grey) {
  for (std::uint32_t x = 0; x < width_px; ++x) grey[x] = row[2 * x];
}

/// `red` and `blue` are their positions in a pixel's three bytes. The weights, in units of 1/256, add up
/// to 1.
void grey_from_rgb(const std::uint8_t* row, unsigned red, unsigned blue, std::uint32_t width_px,
                   std::uint8_t* grey) {
  for (std::uint32_t x = 0; x < width_px; ++x) {
    const std::uint8_t* pixel = row + 3 * x;
    grey[x] = static_cast<std::uint8_t>((77u * pixel[red] + 150u * pixel[1] + 29u * pixel[blue] + 128u) >> 8);
  }
}

}  // namespace

std::span<const PixelFormat> pixel_formats() {
  return kFormats;
}

const char* to_string(PixelFormat format) {
  switch (format) {
    case PixelFormat::Grey:
      return "GREY";
    case PixelFormat::Nv12:
      return "NV12";
    case PixelFormat::Yuyv:
      return "YUYV";
    case PixelFormat::Rgb3:
      return "RGB3";
    case PixelFormat::Bgr3:
      return "BGR3";
    case PixelFormat::Mjpg:
      return "MJPG";
  }
  return "?";
}

bool parse_pixel_format(const std::string& name, PixelFormat& format) {
  for (const PixelFormat known : pixel_formats()) {
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
    case PixelFormat::Rgb3:
    case PixelFormat::Bgr3:
      return 3 * width_px;
    case PixelFormat::Mjpg:
      break;
  }
  return 0;
}

std::size_t luma_bytes_needed(PixelFormat format, std::uint32_t width_px, std::uint32_t height_px,
                              std::uint32_t stride_bytes) {
  if (format == PixelFormat::Mjpg || height_px == 0) return 0;
  // The last row is not always padded to the stride.
  return std::size_t{stride_bytes} * (height_px - 1) + row_bytes(format, width_px);
}

Luma luma_of(PixelFormat format, const std::uint8_t* data, std::uint32_t stride_bytes, std::uint32_t width_px,
             std::uint32_t height_px, std::uint8_t* grey) {
  if (format == PixelFormat::Grey || format == PixelFormat::Nv12) return {data, stride_bytes};
  const unsigned red = format == PixelFormat::Rgb3 ? 0 : 2, blue = 2 - red;
  for (std::uint32_t y = 0; y < height_px; ++y) {
    const std::uint8_t* row = data + std::size_t{y} * stride_bytes;
    std::uint8_t* out = grey + std::size_t{y} * width_px;
    if (format == PixelFormat::Yuyv)
      grey_from_yuyv(row, width_px, out);
    else
      grey_from_rgb(row, red, blue, width_px, out);
  }
  return {grey, width_px};
}

}  // namespace heel
