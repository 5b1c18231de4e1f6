// The dominant orientation of a feature: Haar responses of side 4 s within a radius of 6 s, weighted by a
// Gaussian and summed over a sliding window of π/3.
//
// Convention: from +x (right) towards +y (down). Units: radians.
// Source: H. Bay et al., "Speeded-Up Robust Features (SURF)", CVIU 2008, 4.1. The paper has s = sigma; s =
// 1.2 sigma is more repeatable.
#pragma once

#include "heel/features.h"
#include "vision/features/integral_image.h"

namespace heel {

/// In (−π, π]; 0 where the image has no gradient.
float dominant_orientation(const IntegralImage& integral, const Feature& feature);

}  // namespace heel
