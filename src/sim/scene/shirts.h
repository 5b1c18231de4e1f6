// Printed shirts, drawn by formula: from a bold design made to be followed to ones that cannot be.
#pragma once

#include <cstdint>
#include <string>

#include "sim/render/texture.h"

namespace heel::sim {

enum class ShirtDesign : std::uint8_t {
  Bold,       ///< large and small shapes of strong contrast, nowhere repeated
  Mosaic,     ///< irregular patches of grey
  Blobs,      ///< soft-edged blotches of three tones, as on camouflage
  Jersey,     ///< bare cloth but for bars and two large figures
  Dotted,     ///< the same dot in every cell of a grid
  Striped,    ///< horizontal stripes: texture without identity
  FineCheck,  ///< checks of a centimetre: gone at a few metres
  Plain,      ///< bare cloth
  Marked,     ///< plain, with white dots at shirt_mark(): for tests of the geometry
};

/// Throws heel::Error naming the known designs.
ShirtDesign shirt_design(const std::string& name);

/// A shirt's cloth is unrolled: s runs once around the body (the middle of the back in the middle), t down
/// from the collar.
inline constexpr double kShirtTexelsPerM = 1000.0;
inline constexpr int kShirtWidthTexels = 1024;  ///< once around
inline constexpr int kShirtHeightTexels = 1024;

Canvas draw_shirt(ShirtDesign design, std::uint64_t seed);

/// The dots of ShirtDesign::Marked: count and centres, in texels.
inline constexpr int kShirtMarks = 9;
struct ShirtMark {
  double s_texel = 0.0, t_texel = 0.0;
};
ShirtMark shirt_mark(int index);

}  // namespace heel::sim
