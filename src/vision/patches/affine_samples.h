// Samples of a picture on an oblique grid, computed with vector instructions. Results are the same to the bit
// on every instruction set.
//
// Convention: integer coordinates are pixel centres. Units: pixels, grey levels.
#pragma once

#include <Eigen/Core>

namespace heel {

/// A row of samples is written up to this many values past its last.
inline constexpr int kSampleRowPadding = 7;

/// `side` × `side` bilinear samples round `centre_px`, row by row without padding but after the last row; a
/// step to the right and a step down are the columns of `step_px`. All of them must lie inside the picture,
/// one pixel from its right and lower edge. `stride` is in values.
void sample_affine(const float* grey, int stride, const Eigen::Vector2d& centre_px,
                   const Eigen::Matrix2d& step_px, int side, float* out);

}  // namespace heel
