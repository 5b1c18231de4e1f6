// Uneven indoor light: brighter and darker places, light from above and from a row of windows.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "sim/render/exposure.h"

namespace heel::sim {

struct LightSettings {
  double level = 1.0;                ///< brightness of the picture; noise stays, so less is noisier
  double unevenness = 0.35;          ///< 0: the same everywhere; 0.5: places half as bright again
  double window_azimuth_rad = 0.9;   ///< where the windows are, seen from the middle of the room
  std::vector<LightChange> changes;  ///< lamps that go out or on, for the whole room; in order of time
};

class Light {
 public:
  Light(const LightSettings& settings, std::uint64_t seed);
  /// Irradiance of a surface: about `level` for a wall, more where the windows shine.
  float at(const Eigen::Vector3f& position_m, const Eigen::Vector3f& normal) const;

 private:
  LightSettings settings_;
  Eigen::Vector3f window_;
  float phase_x_;
  float phase_y_;
};

}  // namespace heel::sim
