// The dominant orientation of a feature (H. Bay et al., CVIU 2008, 4.1): Haar responses of side 4 s within a
// radius of 6 s, weighted by a Gaussian, summed over a sliding window of π/3. The paper has s = sigma; a
// little more makes it steadier.
#pragma once

#include "heel/features.h"
#include "vision/features/integral_image.h"

namespace heel {

/// From +x towards +y, in (−π, π]. 0 where there is no gradient at all.
float dominant_orientation(const IntegralImage& integral, const Feature& feature);

}  // namespace heel
