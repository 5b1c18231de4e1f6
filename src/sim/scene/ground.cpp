#include "sim/scene/ground.h"

#include <cmath>
#include <numbers>

#include "core/random.h"

namespace heel::sim {
namespace {

constexpr double kHalfBase_m = 0.125;  ///< P3-AT: axles 0.25 m apart, wheels of one axle 0.40 m
constexpr double kHalfTrack_m = 0.20;

}  // namespace

Ground::Ground(double bump_m, std::uint64_t seed) : level_(bump_m <= 0.0) {
  Random random(derived_seed(seed, 0x31));
  double length_m = 0.18;
  for (Wave& wave : waves_) {
    const double direction = random.uniform(0.0, 2.0 * std::numbers::pi);
    const double k = 2.0 * std::numbers::pi / length_m;
    wave = {k * std::cos(direction), k * std::sin(direction), random.uniform(0.0, 2.0 * std::numbers::pi),
            bump_m * std::sqrt(2.0 / static_cast<double>(waves_.size()))};
    length_m *= 1.31;  // to two metres
  }
}

double Ground::height_m(double x_m, double y_m) const {
  double sum = 0.0;
  for (const Wave& wave : waves_)
    sum += wave.height_m * std::sin(wave.kx * x_m + wave.ky * y_m + wave.phase_rad);
  return sum;
}

GroundPose Ground::pose_at(double x_m, double y_m, double heading_rad) const {
  if (level_) return {};
  const double c = std::cos(heading_rad);
  const double s = std::sin(heading_rad);
  const auto under = [&](double ahead, double left) {
    return height_m(x_m + c * ahead - s * left, y_m + s * ahead + c * left);
  };
  const double front_left = under(kHalfBase_m, kHalfTrack_m);
  const double front_right = under(kHalfBase_m, -kHalfTrack_m);
  const double rear_left = under(-kHalfBase_m, kHalfTrack_m);
  const double rear_right = under(-kHalfBase_m, -kHalfTrack_m);
  const double nose = 0.5 * (front_left + front_right - rear_left - rear_right);
  const double left = 0.5 * (front_left + rear_left - front_right - rear_right);
  return {0.25 * (front_left + front_right + rear_left + rear_right), std::atan2(nose, 2.0 * kHalfBase_m),
          std::atan2(left, 2.0 * kHalfTrack_m)};
}

}  // namespace heel::sim
