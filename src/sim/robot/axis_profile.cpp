#include "sim/robot/axis_profile.h"

#include <algorithm>
#include <cmath>

namespace heel::sim {
namespace {

constexpr double kArrived = 1e-4;  // m or rad

}  // namespace

void AxisProfile::step_to_speed(double wanted, const AxisLimits& limits, double dt_s) {
  wanted = std::clamp(wanted, -limits.speed, limits.speed);
  const bool reverses = wanted * speed_ < 0.0;
  if (!reverses && std::abs(wanted) > std::abs(speed_)) {
    const double step = limits.acceleration * dt_s;
    speed_ += std::clamp(wanted - speed_, -step, step);
    return;
  }
  const double step = limits.deceleration * dt_s;
  const double floor = reverses ? 0.0 : wanted;
  speed_ += std::clamp(floor - speed_, -step, step);
}

bool AxisProfile::step_to_distance(double remaining, const AxisLimits& limits, double dt_s) {
  const double s = std::abs(remaining);
  if (s < kArrived && std::abs(speed_) <= 2.0 * limits.deceleration * dt_s) {
    speed_ = 0.0;
    return true;
  }
  // v² = 2 a s, and never past the goal within this step.
  const double speed = std::min({limits.speed, std::sqrt(2.0 * limits.deceleration * s), s / dt_s});
  step_to_speed(std::copysign(speed, remaining), limits, dt_s);
  return false;
}

}  // namespace heel::sim
