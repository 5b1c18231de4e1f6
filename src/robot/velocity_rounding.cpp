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
  carry_ += clamped - whole;  // −0.5…0.5 also at the limit, because the carry is that of the clamped velocity
  return static_cast<std::int16_t>(whole);
}

}  // namespace heel
