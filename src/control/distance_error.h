// Errors of the distance to the person, as the control laws share them.
#pragma once

#include <cmath>

#include "heel/flow.h"

namespace heel {

/// Zero inside the band, continuous outside.
inline double with_deadband(double error, double band) {
  if (std::abs(error) <= band) return 0.0;
  return error - std::copysign(band, error);
}

/// How far behind the person the goal is, along the heading `psi_rad` to have there.
inline double distance_behind_m(const TargetState& target, double psi_rad) {
  return (target.x_m - target.goal_x_m) * std::cos(psi_rad) +
         (target.y_m - target.goal_y_m) * std::sin(psi_rad);
}

}  // namespace heel
