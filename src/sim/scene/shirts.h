// Procedural prints of shirts: from a design that is easy to follow to designs that cannot be followed.
#pragma once

#include <cstdint>
#include <string>

#include "sim/render/texture.h"

namespace heel::sim {

enum class ShirtDesign : std::uint8_t {
  Bold,       ///< large and small shapes of strong contrast, without repetition
  Mosaic,     ///< irregular patches of grey
  Blobs,      ///< soft-edged blobs of three grey levels, as on camouflage
  Jersey,     ///< plain cloth with a bar and two large digits
  Dotted,     ///< the same dot in every cell of a grid
  Striped,    ///< horizontal stripes, all alike
  FineCheck,  ///< squares of a centimetre, too small for a camera a few metres away
  Shapes,     ///< separate shapes of many kinds on light cloth
  Emblem,     ///< a small emblem on plain cloth
  Photo,      ///< a photograph: soft above, small lights below
  Text,       ///< lines of words
  Plain,      ///< plain cloth
  Marked,     ///< plain, with white dots at shirt_mark(): for tests of the geometry
};

/// Throws heel::Error naming the known designs.
ShirtDesign shirt_design(const std::string& name);

/// Texture coordinates of the cloth: s once around the body (the middle of the back in the middle), t down
/// from the collar.
inline constexpr double kShirtTexelsPerM = 1000.0;
inline constexpr int kShirtWidthTexels = 1024;  ///< once around
inline constexpr int kShirtHeightTexels = 1024;

Canvas draw_shirt(ShirtDesign design, std::uint64_t seed);

/// The dots of ShirtDesign::Marked: their number, and their centres in texels.
inline constexpr int kShirtMarks = 9;
struct ShirtMark {
  double s_texel = 0.0, t_texel = 0.0;
};
ShirtMark shirt_mark(int index);

}  // namespace heel::sim
