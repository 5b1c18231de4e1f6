// KPD files: the keypoints and descriptors of one image, for the comparison of extractors.
//   text    "KPDT 1 N D W H W0 H0", then a line each: x y size angle response octave laplacian d0 … d(D−1)
//   binary  int32 {"KPDB", 1, N, D, W, H, W0, H0}, then a record each: the same, as float32, little endian
// size is a diameter, 7.5 sigma (9 at the finest filter, sigma 1.2); angle in degrees.
#pragma once

#include <string>

#include "heel/features.h"

namespace heel {

/// Writes text when the name ends in .txt, binary otherwise. Throws heel::Error naming the file.
void write_kpd_file(const FeatureSet& features, int width_px, int height_px, const std::string& path);

}  // namespace heel
