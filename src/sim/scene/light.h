// Uneven indoor light: bright and dark places, light from above and from a row of windows.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "sim/render/exposure.h"

namespace heel::sim {

struct LightSettings {
  double level = 1.0;          ///< brightness; the noise does not change, so that a lower level is noisier
  double unevenness = 0.35;    ///< 0: the same light everywhere; 0.5: from half the light to 1.5 times
  double window_share = 0.55;  ///< light from the windows, or from the sun
  double window_azimuth_rad = 0.9;   ///< direction of the windows from the middle of the room
  std::vector<LightChange> changes;  ///< lamps switched off or on, for the whole room; in order of time
};

class Light {
 public:
  Light(const LightSettings& settings, std::uint64_t seed);
  /// Irradiance of a surface: about `level` for a wall, more towards the windows.
  float at(const Eigen::Vector3f& position_m, const Eigen::Vector3f& normal) const;

 private:
  LightSettings settings_;
  Eigen::Vector3f window_;
  float phase_x_;
  float phase_y_;
};

}  // namespace heel::sim
