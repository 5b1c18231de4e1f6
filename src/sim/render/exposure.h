// Shutter time and gain over a run: fixed, or changed in steps by an automatic exposure that follows the
// light with a delay.
#pragma once

#include <vector>

namespace heel::sim {

/// From `t_s` on, the light of the whole room is `level` times the normal one.
struct LightChange {
  double t_s = 0.0;
  double level = 1.0;
};

struct ExposureSettings {
  bool automatic = false;
  double longest_ms = 25.0;  ///< automatic: first the shutter time grows to this, then the gain
  double most_gain = 16.0;
  double lag_s = 0.25;      ///< time between two steps
  double step_stops = 0.5;  ///< a step changes the exposure by the factor 2^step_stops
};

struct Exposure {
  double light = 1.0;        ///< level of the room's light after its changes
  double exposure_ms = 8.0;  ///< shutter time
  double gain = 1.0;         ///< analog gain on top of the sensor's base gain: noise grows with it
};

/// Computed at construction, so that the result depends on the time only and not on the order of calls. The
/// automatic exposure answers the room's light changes; it does not measure the pictures.
class ExposureControl {
 public:
  /// `exposure_ms` is the right one at light 1. `changes` are in order of time.
  ExposureControl(const ExposureSettings& settings, double exposure_ms,
                  const std::vector<LightChange>& changes, double duration_s);

  Exposure at(double t_s) const;

 private:
  double light_at(double t_s) const;

  double exposure_ms_;
  double lag_s_;
  std::vector<LightChange> changes_;
  std::vector<Exposure> steps_;  ///< one every lag_s_; empty when the exposure is fixed
};

}  // namespace heel::sim
