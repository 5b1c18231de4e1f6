// Other answers to the same picture. Few pairs, or pairs of one facet only, are explained nearly as well by a
// back turned otherwise. The best explanation is given; that it may be the wrong one belongs to its
// deviation.
#pragma once

#include <span>

#include "vision/pose/motion_refine.h"

namespace heel {

struct AlternativeHypothesis {
  FrontalMotion motion;
  double odds = 0.0;  ///< of being true, against the pose that was chosen
};

/// Adds to the pose's deviations, and to its ambiguity, what it would be off by if one of the
/// alternative_hypotheses were true.
void inflate_covariance(std::span<const AlternativeHypothesis> alternative_hypotheses, FrontalPose& pose);

/// How far apart two motions' yaws are, 0…π.
double yaw_between(const FrontalMotion& a, const FrontalMotion& b);

}  // namespace heel
