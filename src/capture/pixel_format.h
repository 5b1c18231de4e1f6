// The picture formats heel takes from cameras, and how their luma is got at. Pixels inside heel are 8-bit
// grey.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace heel {

enum class PixelFormat : std::uint8_t {
  Grey,  ///< one byte a pixel
  Nv12,  ///< a plane of luma, then interleaved chroma at half size
  Yuyv,  ///< Y0 U Y1 V: two bytes a pixel
  Mjpg,  ///< a JPEG image a frame
};

/// "GREY", "NV12", "YUYV", "MJPG", as in camera.format.
const char* to_string(PixelFormat format);
/// False: no format of that name.
bool parse_pixel_format(const std::string& name, PixelFormat& format);

/// Bytes from the first to past the last luma byte that is read of a frame; 0 for Mjpg, which has no fixed
/// size.
std::size_t luma_bytes_needed(PixelFormat format, std::uint32_t width_px, std::uint32_t height_px,
                              std::uint32_t stride_bytes);

/// Bytes of a row of luma (with what is interleaved): the smallest stride there can be. 0 for Mjpg.
std::uint32_t row_bytes(PixelFormat format, std::uint32_t width_px);

/// Every second byte of YUYV is luma. `grey` gets width × height, densely packed.
void grey_from_yuyv(const std::uint8_t* yuyv, std::uint32_t stride_bytes, std::uint32_t width_px,
                    std::uint32_t height_px, std::uint8_t* grey);

}  // namespace heel
