// The pixel formats that heel takes from cameras, and their luma. Images inside heel are 8-bit grey.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace heel {

enum class PixelFormat : std::uint8_t {
  Grey,  ///< one byte a pixel
  Nv12,  ///< a plane of luma, then interleaved chroma at half size
  Yuyv,  ///< Y0 U Y1 V: two bytes a pixel
  Rgb3,  ///< red, green, blue: three bytes a pixel
  Bgr3,  ///< blue, green, red
  Mjpg,  ///< each frame is a JPEG image
};

/// All formats in the order in which `auto` tries them: by conversion cost, the cheapest first.
std::span<const PixelFormat> pixel_formats();

/// "GREY", "NV12", "YUYV", "RGB3", "BGR3", "MJPG", as in camera.format.
const char* to_string(PixelFormat format);
/// False: no format of that name.
bool parse_pixel_format(const std::string& name, PixelFormat& format);

/// The bytes of a frame up to the last one that is read; 0 for Mjpg, which has no fixed size.
std::size_t luma_bytes_needed(PixelFormat format, std::uint32_t width_px, std::uint32_t height_px,
                              std::uint32_t stride_bytes);

/// The bytes of a row (of luma, where that is a plane of its own), which is the smallest possible stride; 0
/// for Mjpg.
std::uint32_t row_bytes(PixelFormat format, std::uint32_t width_px);

/// A plane of luma.
struct Luma {
  const std::uint8_t* data = nullptr;
  std::uint32_t stride_bytes = 0;
};

/// The luma of a frame in any format but Mjpg: inside the frame where it has a plane of luma, else converted
/// to `grey` (width × height bytes, densely packed). Luma of RGB is that of BT.601, as in JPEG: 0.299 R +
/// 0.587 G + 0.114 B.
Luma luma_of(PixelFormat format, const std::uint8_t* data, std::uint32_t stride_bytes, std::uint32_t width_px,
             std::uint32_t height_px, std::uint8_t* grey);

}  // namespace heel
