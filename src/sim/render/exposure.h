// Shutter time and gain over a run: fixed, or by the steps of an automatic exposure that lags behind the
// light.
#pragma once

#include <vector>

namespace heel::sim {

/// From `t_s` on the light of the whole room is `level` times what it is by itself.
struct LightChange {
  double t_s = 0.0;
  double level = 1.0;
};

struct ExposureSettings {
  bool automatic = false;
  double longest_ms = 25.0;  ///< automatic: first the shutter opens longer, then the gain goes up
  double most_gain = 16.0;
  double lag_s = 0.25;      ///< between two steps
  double step_stops = 0.5;  ///< a step: factor 2^this
};

struct Exposure {
  double light = 1.0;        ///< of the room, as the changes have it
  double exposure_ms = 8.0;  ///< shutter time
  double gain = 1.0;         ///< analog, beyond the sensor's base gain: noise grows with it
};

/// Worked out at construction: a function of time only, whoever asks in whatever order. The automatic knows
/// the room's light changes, not what the picture shows of them.
class ExposureControl {
 public:
  /// `exposure_ms` is right at light 1. `changes` in order of time.
  ExposureControl(const ExposureSettings& settings, double exposure_ms,
                  const std::vector<LightChange>& changes, double duration_s);

  Exposure at(double t_s) const;

 private:
  double light_at(double t_s) const;

  double exposure_ms_;
  double lag_s_;
  std::vector<LightChange> changes_;
  std::vector<Exposure> steps_;  ///< one every lag; empty when fixed
};

}  // namespace heel::sim
