#include "capture/luma_converter.h"

#include <cstring>

#include "files/one_field.h"

namespace heel {

void LumaConverter::configure(PixelFormat format, std::uint32_t width_px, std::uint32_t height_px,
                              std::uint32_t stride_bytes, bool interlaced) {
  format_ = format;
  width_px_ = width_px;
  height_px_ = height_px;
  stride_bytes_ = stride_bytes;
  interlaced_ = interlaced;
  grey_.assign(std::size_t{width_px} * height_px, 0);
}

bool LumaConverter::convert(const std::uint8_t* buffer, std::size_t used_bytes, std::size_t buffer_bytes,
                            FrameView& frame) {
  if (used_bytes == 0 || used_bytes > buffer_bytes ||
      used_bytes < luma_bytes_needed(format_, width_px_, height_px_, stride_bytes_)) {
    problem_ = "the frame is too short";
    return false;
  }
  Luma luma{grey_.data(), width_px_};
  if (format_ != PixelFormat::Mjpg) {
    luma = luma_of(format_, buffer, stride_bytes_, width_px_, height_px_, grey_.data());
  } else if (!jpeg_.decode(buffer, used_bytes, width_px_, height_px_, grey_.data())) {
    problem_ = jpeg_.problem();
    return false;
  }
  if (interlaced_) luma = one_field(luma);
  frame.grey = luma.data;
  frame.stride_bytes = luma.stride_bytes;
  return true;
}

/// The picture in grey_, with the rows 1, 3, … from those above and below.
Luma LumaConverter::one_field(const Luma& luma) {
  if (luma.data != grey_.data())
    for (std::uint32_t y = 0; y < height_px_; y += 2)
      std::memcpy(grey_.data() + std::size_t{y} * width_px_, luma.data + std::size_t{y} * luma.stride_bytes,
                  width_px_);
  keep_one_field(grey_.data(), width_px_, height_px_, width_px_);
  return {grey_.data(), width_px_};
}

}  // namespace heel
