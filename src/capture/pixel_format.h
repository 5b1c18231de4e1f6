// The picture formats heel takes from cameras, and how their luma is got at. Pixels inside heel are 8-bit
// grey.
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
  Mjpg,  ///< a JPEG image a frame
};

/// All of them, the least work first: what `auto` tries in turn.
std::span<const PixelFormat> pixel_formats();

/// "GREY", "NV12", "YUYV", "RGB3", "BGR3", "MJPG", as in camera.format.
const char* to_string(PixelFormat format);
/// False: no format of that name.
bool parse_pixel_format(const std::string& name, PixelFormat& format);

/// Bytes from the first to past the last byte that is read of a frame; 0 for Mjpg, which has no fixed size.
std::size_t luma_bytes_needed(PixelFormat format, std::uint32_t width_px, std::uint32_t height_px,
                              std::uint32_t stride_bytes);

/// Bytes of a row (of luma, where that is a plane of its own): the smallest stride there can be. 0 for Mjpg.
std::uint32_t row_bytes(PixelFormat format, std::uint32_t width_px);

/// A plane of luma.
struct Luma {
  const std::uint8_t* first = nullptr;
  std::uint32_t stride_bytes = 0;
};

/// Of a frame in any format but Mjpg: where it lies in the frame, if it does, else in `grey`, which then gets
/// width × height, densely packed. Luma of RGB is that of BT.601, as in JPEG: 0.299 R + 0.587 G + 0.114 B.
Luma luma_of(PixelFormat format, const std::uint8_t* data, std::uint32_t stride_bytes, std::uint32_t width_px,
             std::uint32_t height_px, std::uint8_t* grey);

}  // namespace heel
