// Other poses that explain the same frame nearly as well. If the pairs are few, or lie on one facet of the
// back, a back at another yaw fits nearly as well. The best pose is reported; the chance that it is wrong is
// part of its sigma.
//
// Convention: odds are relative to the reported pose. Units: radians, t/d.
#pragma once

#include <span>

#include "vision/pose/frontal_pose_estimator.h"

namespace heel {

struct AlternativeHypothesis {
  FrontalMotion motion;
  double odds = 0.0;  ///< of being the true one, relative to the chosen pose
};

/// Adds to the sigmas of the pose its expected squared error if an alternative is the true pose, and to its
/// ambiguity the probability of that.
void inflate_covariance(std::span<const AlternativeHypothesis> alternatives, FrontalPose& pose);

/// The difference of the yaws of two motions, 0…π.
double yaw_difference_rad(const FrontalMotion& a, const FrontalMotion& b);

}  // namespace heel
