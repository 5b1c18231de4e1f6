// The SURF-64 descriptor (H. Bay et al., CVIU 2008, 4.2): Σdx, Σdy, Σ|dx|, Σ|dy| of Haar responses in 4 × 4
// subregions, the subregions overlapping and weighted in two stages (M. Agrawal et al., "CenSurE", ECCV 2008,
// 4): 24 × 24 responses one sigma apart, subregions of 9 × 9 every 5. A response is the difference of box
// means of side 2 sigma that overlap by half: smoother than the paper's wavelet, and better matched.
#pragma once

#include "heel/features.h"
#include "vision/features/integral_image.h"

namespace heel {

/// Rotated by feature.angle_rad unless `upright`. Order: subregion row, subregion column, (Σdx, Σdy, Σ|dx|,
/// Σ|dy|); unit length, or all zero where the image is flat.
void describe(const IntegralImage& integral, const Feature& feature, bool upright, Descriptor& descriptor);

}  // namespace heel
