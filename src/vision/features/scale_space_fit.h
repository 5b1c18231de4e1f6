// Sub-sample position of a maximum of responses over column, row and layer: the peak of a quadratic through
// its 27 neighbours (M. Brown and D. Lowe, "Invariant features from interest point groups", BMVC 2002).
#pragma once

#include <array>
#include <optional>

#include "vision/features/hessian_rows.h"

namespace heel {

/// Offsets from the middle sample: at most one sample, and half a layer, so that every sigma belongs to one
/// layer of an octave.
struct ScaleSpacePeak {
  float dx = 0.f, dy = 0.f, dlayer = 0.f;
  float response = 0.f;  ///< of the quadratic at the peak
};

/// Responses of three neighbouring layers (finer, own, coarser): [layer][row][column].
using ResponseCube = std::array<ResponsePatch, 3>;

/// Nothing when the middle sample is not the maximum of the cube (of equals the first in layer, row and
/// column order counts), when the quadratic has no peak, or when it lies too far off.
std::optional<ScaleSpacePeak> fit_scale_space_peak(const ResponseCube& cube);

}  // namespace heel
