#pragma once

#include <cmath>

namespace heel::errors {

/// To −π … π.
inline double wrapped(double angle_rad) {
  return std::remainder(angle_rad, 2.0 * M_PI);
}

}  // namespace heel::errors
