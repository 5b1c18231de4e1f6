// What a world is used for.
#pragma once

#include <cstdint>

namespace heel::sim {

enum class WorldUse : std::uint8_t {
  Rendering,  ///< pictures and truth
  TruthOnly,  ///< truth without rendering: no textures and no renderer; a thousand times faster to make
};

}  // namespace heel::sim
