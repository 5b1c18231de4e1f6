// Turns a driver's buffers into 8-bit grey images: in place where the format has a plane of luma, else by
// conversion.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "capture/pixel_format.h"
#include "files/jpeg_decoder.h"
#include "heel/flow.h"

namespace heel {

class LumaConverter {
 public:
  /// Allocates the image for frames of this format and size. `stride_bytes` is not used for Mjpg.
  /// `interlaced`: every second row is of another time; those are replaced by the mean of their neighbours.
  void configure(PixelFormat format, std::uint32_t width_px, std::uint32_t height_px,
                 std::uint32_t stride_bytes, bool interlaced = false);

  /// Converts the first `used_bytes` of a buffer of `buffer_bytes`, and sets the image of `frame`, which is
  /// valid until the next call and as long as the buffer is. False: the frame is too short or damaged;
  /// problem() says which.
  bool convert(const std::uint8_t* buffer, std::size_t used_bytes, std::size_t buffer_bytes,
               FrameView& frame);
  const char* problem() const { return problem_; }

 private:
  Luma one_field(const Luma& luma);

  PixelFormat format_ = PixelFormat::Grey;
  std::uint32_t width_px_ = 0;
  std::uint32_t height_px_ = 0;
  std::uint32_t stride_bytes_ = 0;
  bool interlaced_ = false;
  JpegDecoder jpeg_;
  std::vector<std::uint8_t> grey_;  // the image, for formats without a plane of luma and for interlaced ones
  const char* problem_ = "";
};

}  // namespace heel
