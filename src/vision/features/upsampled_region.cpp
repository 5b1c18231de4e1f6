#include "vision/features/upsampled_region.h"

#include <algorithm>
#include <cstddef>

namespace heel {

UpsampledRegion::UpsampledRegion(int max_width_px, std::size_t max_area_px)
    : max_width_px_(max_width_px),
      pixels_(max_area_px),
      row_(static_cast<std::size_t>(max_width_px) / kFactor + 2) {}

bool UpsampledRegion::has_room_for(const Region& part) const {
  const auto width = static_cast<std::size_t>(part.width_px),
             height = static_cast<std::size_t>(part.height_px);
  return kFactor * part.width_px <= max_width_px_ && kFactor * kFactor * width * height <= pixels_.size();
}

// Bilinear. The centre of each new pixel lies a quarter of a pixel from that of the nearest old one, so the
// weights are 3/4 and 1/4 in each direction: sixteenths, which integers hold exactly. Edge pixels are
// repeated outwards.
FrameView UpsampledRegion::upsample(const FrameView& frame, const Region& part) {
  part_ = part;
  const auto width = static_cast<std::size_t>(part.width_px);
  const auto stride = static_cast<std::size_t>(frame.stride_bytes);
  const std::uint8_t* first =
      frame.grey + static_cast<std::size_t>(part.y_px) * stride + static_cast<std::size_t>(part.x_px);
  std::uint16_t* const quarters = row_.data() + 1;  // one more column on each side
  for (int y = 0; y < kFactor * part.height_px; ++y) {
    const int near_y = y / 2, far_y = std::clamp(y % 2 == 0 ? near_y - 1 : near_y + 1, 0, part.height_px - 1);
    const std::uint8_t* const near_row = first + static_cast<std::size_t>(near_y) * stride;
    const std::uint8_t* const far_row = first + static_cast<std::size_t>(far_y) * stride;
    for (std::size_t x = 0; x < width; ++x)
      quarters[x] = static_cast<std::uint16_t>(3 * near_row[x] + far_row[x]);
    row_[0] = quarters[0];
    quarters[width] = quarters[width - 1];
    std::uint8_t* const out = pixels_.data() + static_cast<std::size_t>(y) * kFactor * width;
    for (std::size_t x = 0; x < width; ++x) {
      const int here = 3 * quarters[x] + 8;
      out[2 * x] = static_cast<std::uint8_t>((here + row_[x]) / 16);
      out[2 * x + 1] = static_cast<std::uint8_t>((here + quarters[x + 1]) / 16);
    }
  }
  FrameView view = frame;
  view.header.width_px = static_cast<std::uint32_t>(kFactor * part.width_px);
  view.header.height_px = static_cast<std::uint32_t>(kFactor * part.height_px);
  view.grey = pixels_.data();
  view.stride_bytes = view.header.width_px;
  return view;
}

}  // namespace heel
