// Grey texture with detail at every size: what stands round the back in a made picture.
#pragma once

#include <cstdint>
#include <vector>

namespace heel {

/// Row-major, width_px × height_px; of mean 0 and a standard deviation of 1. The same seed gives the same
/// texture.
std::vector<float> grey_texture(int width_px, int height_px, std::uint32_t seed);

}  // namespace heel
