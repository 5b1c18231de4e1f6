// The position of a maximum of responses between samples of column, row and layer: the peak of a quadratic
// through the 27 samples round it.
//
// Convention: offsets from the middle sample, in samples and layers.
// Source: M. Brown and D. Lowe, "Invariant features from interest point groups", BMVC 2002.
#pragma once

#include <array>
#include <optional>

#include "vision/features/hessian_rows.h"

namespace heel {

/// Offsets of at most one sample, and half a layer: so every sigma belongs to one layer of an octave.
struct ScaleSpacePeak {
  float dx = 0.f, dy = 0.f, dlayer = 0.f;
  float response = 0.f;  ///< of the quadratic at the peak
};

/// Responses of three neighbouring layers (finer, own, coarser): [layer][row][column].
using ResponseCube = std::array<ResponsePatch, 3>;

/// None if the middle sample is not the maximum of the cube (among equals, the first in the order of layer,
/// row and column is the maximum), if the quadratic has no peak, or if the peak is too far from the middle.
std::optional<ScaleSpacePeak> fit_scale_space_peak(const ResponseCube& cube);

}  // namespace heel
