// A part of a frame enlarged by two, in which the smallest filter finds blobs of half its size.
//
// Convention: integer coordinates are pixel centres, in the frame and in the enlarged picture. Units: pixels.
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
  /// Border of the frame that is upsampled with a region, since descriptors extend beyond the region.
  static constexpr int kBorder_px = 16;

  /// Takes memory once, for an enlarged picture of at most this width and this many pixels. With the width
  /// and area of a frame a search costs no more than a frame, and the picture may be taller than a frame, as
  /// a torso is.
  UpsampledRegion(int max_width_px, std::size_t max_area_px);

  bool has_room_for(const Region& part) const;
  /// `part` must lie inside the frame, and there must be room for it. The returned view is valid until the
  /// next call; its pixel (x, y) lies at (x_in_frame(x), y_in_frame(y)) of the frame.
  FrameView upsample(const FrameView& frame, const Region& part);

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
