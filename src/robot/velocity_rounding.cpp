#include "robot/velocity_rounding.h"

#include <algorithm>
#include <cmath>

namespace heel {

std::int16_t VelocityRounding::next(double wanted) {
  if (!std::isfinite(wanted) || wanted == 0.0) {
    carry_ = 0.0;
    return 0;
  }
  const double limit = limit_;
  const double clamped = std::clamp(wanted, -limit, limit);
  const double whole = std::clamp(std::round(clamped + carry_), -limit, limit);
  // Without this clamp it would grow while the command is at the limit.
  carry_ = std::clamp(carry_ + clamped - whole, -0.5, 0.5);
  return static_cast<std::int16_t>(whole);
}

}  // namespace heel
