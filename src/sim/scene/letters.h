// Capital letters as grids of five by seven cells.
#pragma once

#include <string_view>

#include "sim/render/texture.h"

namespace heel::sim {

/// Draws a word of capital letters; (x, y) is its upper left corner, in texels. Returns its width.
double draw_word(Canvas& canvas, std::string_view word, double x, double y, double cell_texel, float grey);
/// The width that draw_word returns.
double word_width(std::string_view word, double cell_texel);

}  // namespace heel::sim
