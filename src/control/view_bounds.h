// Keeps the person in the picture, whatever else a law wants. With beta the person's bearing from the camera
// and D the range, beta' = −omega + (v sin(beta) + V sin(psi − beta)) / D, where the person walks at V in the
// direction psi; a control barrier lets |beta| approach its limit no
// faster than gain · (distance to the limit), which bounds omega on either side (A. Ames et al., "Control
// Barrier Functions: Theory and Applications", ECC 2019, Eq. (17)).
#pragma once

#include <algorithm>
#include <cmath>

#include "estimate/target_measurement.h"
#include "heel/flow.h"

namespace heel {

/// Yaw rates that keep the person's bearing within its limit.
struct YawRateBounds {
  double least_rad_s = 0.0;
  double most_rad_s = 0.0;
};

/// The person's own velocity along their direction of travel and to its left, as far as the law uses it.
struct PersonVelocity {
  double forwards_m_s = 0.0;
  double aside_m_s = 0.0;
};

inline YawRateBounds view_bounds(const TargetState& target, const CameraMount& mount, double v_m_s,
                                 const PersonVelocity& person, double bearing_max_rad, double gain_1_s) {
  constexpr double kLeastRange_m = 0.1;  // a bearing at a smaller range is noise
  const double x_m = target.x_m - mount.x_m;
  const double y_m = target.y_m - mount.y_m;
  const double bearing_rad = std::atan2(y_m, x_m);
  const double across_m_s = v_m_s * std::sin(bearing_rad) +
                            person.forwards_m_s * std::sin(target.travel_yaw_rad - bearing_rad) +
                            person.aside_m_s * std::cos(target.travel_yaw_rad - bearing_rad);
  const double passing_rad_s = across_m_s / std::max(std::hypot(x_m, y_m), kLeastRange_m);
  const double off_axis_rad = bearing_rad - mount.yaw_rad;
  return {passing_rad_s - gain_1_s * (bearing_max_rad - off_axis_rad),
          passing_rad_s + gain_1_s * (bearing_max_rad + off_axis_rad)};
}

}  // namespace heel
