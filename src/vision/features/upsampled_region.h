// A part of a frame, drawn twice as large: so the smallest filter meets blobs of half its size.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "heel/features.h"
#include "heel/flow.h"

namespace heel {

class UpsampledRegion {
 public:
  static constexpr int kFactor = 2;

  /// Takes all memory here, for a picture of at most this width and this many pixels: as large as a frame, so
  /// that it costs no more, but taller, as a torso is.
  UpsampledRegion(int max_width_px, std::size_t max_area_px);

  bool has_room_for(const Region& part) const;
  /// `part` inside the frame, and not too large. The picture is valid until the next call; its pixel (x, y)
  /// has its centre at that of the frame's (x_in_frame(x), y_in_frame(y)).
  FrameView draw(const FrameView& frame, const Region& part);

  float x_in_frame(float x_px) const { return in_frame(x_px, part_.x_px); }
  float y_in_frame(float y_px) const { return in_frame(y_px, part_.y_px); }

 private:
  static float in_frame(float at_px, int start_px) {
    return (at_px + 0.5f) / kFactor - 0.5f + static_cast<float>(start_px);
  }

  int max_width_px_;
  Region part_;
  std::vector<std::uint8_t> pixels_;
  std::vector<std::uint16_t> row_;
};

}  // namespace heel
