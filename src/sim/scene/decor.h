// Procedural textures for floors, walls, boxes and screens.
#pragma once

#include <cstdint>

#include "sim/render/texture.h"

namespace heel::sim {

Canvas draw_floor(std::uint64_t seed);      ///< 1024², speckled tiles
Canvas draw_wall(std::uint64_t seed);       ///< 4096 × 512, doors, posters, shelves
Canvas draw_ceiling(std::uint64_t seed);    ///< 512², panels
Canvas draw_crate(std::uint64_t seed);      ///< 512², boards and labels
Canvas draw_shelf(std::uint64_t seed);      ///< 512², rows of book spines
Canvas draw_pin_board(std::uint64_t seed);  ///< 512², a pin board full of notes
Canvas draw_plaster(std::uint64_t seed);    ///< 512², rough, for poles and partitions
Canvas draw_window();                       ///< 512 × 256, four panes of sky

}  // namespace heel::sim
