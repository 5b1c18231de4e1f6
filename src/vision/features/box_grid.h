// Square patches of box means round a feature: the raw material of orientation and descriptor.
// Lines and boxes need not fall on pixel borders: the integral image is interpolated bilinearly, which makes
// a fractional box exact for square pixels; beyond the border the last row and column go on for ever.
#pragma once

#include <array>

#include "vision/features/integral_image.h"

namespace heel {

inline constexpr int kPatchCells = 25;              ///< cells of a descriptor patch along a side
inline constexpr int kGridLines = kPatchCells + 2;  ///< most lines of a grid along a side
inline constexpr int kPatchStride = 48;             ///< floats from row to row; room for whole vectors

/// value[row * kPatchStride + column]
using Patch = std::array<float, kPatchStride * kGridLines>;

/// Integral image at a grid of `lines` × `lines` points, `spacing_px` apart and centred on pixel position
/// (x, y): box sums are differences of four of them. Sums relative to the grid's middle lines, so that float
/// holds them. lines ≤ kGridLines.
void sample_upright_grid(const IntegralImage& integral, float x_px, float y_px, float spacing_px, int lines,
                         Patch& grid);

/// Sums over kPatchCells² boxes of side 2 · `spacing_px`, each overlapping its neighbours by half, their
/// centres on a grid of that spacing turned by (cos, sin) about (x, y); the boxes themselves stay upright.
void sample_rotated_cells(const IntegralImage& integral, float x_px, float y_px, float spacing_px,
                          float cos_angle, float sin_angle, Patch& cells);

/// The upright counterpart.
void sample_upright_cells(const IntegralImage& integral, float x_px, float y_px, float spacing_px,
                          Patch& cells);

}  // namespace heel
