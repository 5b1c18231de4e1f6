#include "sim/robot/axis_profile.h"

#include <algorithm>
#include <cmath>

namespace heel::sim {
namespace {

constexpr double kGoalTolerance = 1e-4;  // m or rad

}  // namespace

void AxisProfile::step_to_speed(double target, const AxisLimits& limits, double dt_s) {
  target = std::clamp(target, -limits.speed, limits.speed);
  const bool reverses = target * speed_ < 0.0;
  if (!reverses && std::abs(target) > std::abs(speed_)) {
    const double step = limits.acceleration * dt_s;
    speed_ += std::clamp(target - speed_, -step, step);
    return;
  }
  const double step = limits.deceleration * dt_s;
  const double floor = reverses ? 0.0 : target;
  speed_ += std::clamp(floor - speed_, -step, step);
}

bool AxisProfile::step_to_distance(double remaining, const AxisLimits& limits, double dt_s) {
  const double s = std::abs(remaining);
  if (s < kGoalTolerance && std::abs(speed_) <= 2.0 * limits.deceleration * dt_s) {
    speed_ = 0.0;
    return true;
  }
  // v² = 2 a s, and not beyond the goal within this step.
  const double speed = std::min({limits.speed, std::sqrt(2.0 * limits.deceleration * s), s / dt_s});
  step_to_speed(std::copysign(speed, remaining), limits, dt_s);
  return false;
}

}  // namespace heel::sim
