// Prints as they are sold: separate shapes on light cloth, a small emblem, a photograph, lines of text. Drawn
// on the canvas of a shirt (shirts.h).
#pragma once

#include "core/random.h"
#include "sim/render/texture.h"

namespace heel::sim {

void draw_shapes(Canvas& canvas, Random& random);
void draw_emblem(Canvas& canvas, Random& random);
void draw_photo(Canvas& canvas, Random& random);
void draw_text(Canvas& canvas, Random& random);

}  // namespace heel::sim
