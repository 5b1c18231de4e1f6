// Grey pictures to files, the format by the name's ending.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace heel::sim {

/// Throws heel::Error naming the file when it cannot be written.
void write_grey_picture(const std::string& path, const std::vector<std::uint8_t>& grey, int width_px,
                        int height_px);

}  // namespace heel::sim
