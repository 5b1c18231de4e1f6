// What Motion-JPEG does to a grey picture: compressed and decompressed by libjpeg-turbo.
#pragma once

#include <cstdint>
#include <vector>

namespace heel::sim {

/// Compresses `grey` (rows without gaps) at `quality` 1…100 and decompresses it in place. Throws heel::Error
/// with libjpeg's message when that fails.
void jpeg_round_trip(std::vector<std::uint8_t>& grey, int width_px, int height_px, int quality);

}  // namespace heel::sim
