// Frames made for tests: every pixel is a function of sequence and place, so that a mixture of two frames
// shows.
#pragma once

#include <cstdint>

#include "heel/flow.h"
#include "realtime/frame_triple_buffer.h"

namespace heel::test {

inline std::uint8_t made_pixel(std::uint64_t sequence, std::uint32_t x, std::uint32_t y) {
  return static_cast<std::uint8_t>(sequence * 131 + (sequence >> 8) * 29 + y * 17 + x * 3);
}

inline void make_frame(const WritableFrame& slot, std::uint64_t sequence, std::uint32_t width_px,
                       std::uint32_t height_px) {
  *slot.header = {.sequence = sequence,
                  .t_capture_ns = static_cast<TimeNs>(sequence) * 1000,
                  .width_px = width_px,
                  .height_px = height_px};
  for (std::uint32_t y = 0; y < height_px; ++y) {
    for (std::uint32_t x = 0; x < width_px; ++x) {
      slot.grey[y * slot.stride_bytes + x] = made_pixel(sequence, x, y);
    }
  }
}

inline bool is_whole(const FrameView& frame) {
  if (frame.header.t_capture_ns != static_cast<TimeNs>(frame.header.sequence) * 1000) return false;
  for (std::uint32_t y = 0; y < frame.header.height_px; ++y) {
    for (std::uint32_t x = 0; x < frame.header.width_px; ++x) {
      if (frame.grey[y * frame.stride_bytes + x] != made_pixel(frame.header.sequence, x, y)) return false;
    }
  }
  return true;
}

}  // namespace heel::test
