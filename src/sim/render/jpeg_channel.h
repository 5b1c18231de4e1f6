// What Motion-JPEG does to a grey picture: through libjpeg-turbo and back.
#pragma once

#include <cstdint>
#include <vector>

namespace heel::sim {

/// Compresses `grey` (width × height, dense) at `quality` 1…100 and decodes it in place. Throws heel::Error
/// with libjpeg's words where it fails.
void pass_through_jpeg(std::vector<std::uint8_t>& grey, int width_px, int height_px, int quality);

}  // namespace heel::sim
