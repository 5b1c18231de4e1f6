// Square patches of box sums round a feature, from which orientation and descriptor are computed.
//
// Convention: pixel (0,0) is the centre of the top-left pixel; a patch holds value[row * kPatchStride +
// column].
// Units: pixels; sums of grey levels 0…255. Grid lines need not fall on pixel borders: the integral image is
// interpolated bilinearly, which is exact for square pixels. Beyond the image border the last row and column
// are continued.
#pragma once

#include <array>

#include "vision/features/integral_image.h"

namespace heel {

inline constexpr int kPatchCells = 25;              ///< cells of a descriptor patch along a side
inline constexpr int kGridLines = kPatchCells + 2;  ///< most lines of a grid along a side
inline constexpr int kPatchStride = 48;             ///< floats from row to row; room for whole vectors

using Patch = std::array<float, kPatchStride * kGridLines>;

/// The integral image at a grid of `lines` × `lines` points, `spacing_px` apart and centred on pixel position
/// (x, y); lines ≤ kGridLines. A box sum is the difference of four of them. The values are relative to the
/// grid's centre, so that a float holds them exactly enough.
void sample_upright_grid(const IntegralImage& integral, float x_px, float y_px, float spacing_px, int lines,
                         Patch& grid);

/// Sums over kPatchCells² boxes of side 2 · `spacing_px` that overlap their neighbours by half. The centres
/// lie on a grid of that spacing, rotated by (cos, sin) about (x, y); the boxes themselves are not rotated.
void sample_rotated_cells(const IntegralImage& integral, float x_px, float y_px, float spacing_px,
                          float cos_angle, float sin_angle, Patch& cells);

/// The same without rotation.
void sample_upright_cells(const IntegralImage& integral, float x_px, float y_px, float spacing_px,
                          Patch& cells);

}  // namespace heel
