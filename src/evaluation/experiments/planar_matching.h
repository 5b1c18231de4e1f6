// Planar matching as OpenCV offers it, beside heel on the same pictures: features, ratio test, homography by
// MAGSAC, decomposition of the plane. The back is taken for a plane.
#pragma once

#include <vector>

#include "evaluation/experiments/foreign_answers.h"

namespace heel::evaluation {

/// ORB(3000), SIFT, SIFT on the picture enlarged by two, AKAZE.
std::vector<ForeignMethod> planar_methods();

}  // namespace heel::evaluation
