#include "sim/scene/light.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.h"

namespace heel::sim {

Light::Light(const LightSettings& settings, std::uint64_t seed) : settings_(settings) {
  Random random(derived_seed(seed, 0x11));
  phase_x_ = static_cast<float>(random.uniform(0, 2 * std::numbers::pi));
  phase_y_ = static_cast<float>(random.uniform(0, 2 * std::numbers::pi));
  window_ = Eigen::Vector3d(std::cos(settings.window_azimuth_rad), std::sin(settings.window_azimuth_rad), 0.4)
                .normalized()
                .cast<float>();
}

float Light::at(const Eigen::Vector3f& position_m, const Eigen::Vector3f& normal) const {
  const float place = 1.f + static_cast<float>(settings_.unevenness) *
                                std::sin(0.45f * position_m.x() + phase_x_) *
                                std::sin(0.4f * position_m.y() + phase_y_);
  const float above = 0.5f + 0.5f * normal.z();
  const float window = std::max(0.f, normal.dot(window_));
  return static_cast<float>(settings_.level) * place *
         (0.7f + 0.4f * above + static_cast<float>(settings_.window_share) * window);
}

}  // namespace heel::sim
