// The SURF-64 descriptor: Σdx, Σdy, Σ|dx|, Σ|dy| of Haar responses in 4 × 4 subregions.
//
// Convention: dx to the right, dy downwards, both rotated with the feature unless upright.
// Units: positions in pixels; the descriptor has unit length.
// Source: H. Bay et al., CVIU 2008, 4.2; overlapping subregions weighted in two stages: M. Agrawal et al.,
// "CenSurE", ECCV 2008, 4. There are 24 × 24 responses one sigma apart, and a subregion of 9 × 9 every 5. A
// response is the difference of box sums of side 2 sigma that overlap by half; it is smoother than the
// wavelet of the paper and gives more correct matches.
#pragma once

#include <cmath>

#include "heel/features.h"
#include "vision/features/integral_image.h"

namespace heel {

/// How far from the centre of a feature its orientation and its descriptor read the image: grid lines lie up
/// to 13 sigma away, or, rotated, 12 √2 sigma and half a box.
inline int descriptor_reach_px(float sigma_px, bool upright) {
  return static_cast<int>(std::ceil((upright ? 13.f : 18.f) * sigma_px)) + 2;
}

/// Rotated by feature.angle_rad unless `upright`. Order: subregion row, subregion column, (Σdx, Σdy, Σ|dx|,
/// Σ|dy|). All zero where the image is uniform.
void describe(const IntegralImage& integral, const Feature& feature, bool upright, Descriptor& descriptor);

}  // namespace heel
