#include "sim/render/exposure.h"

#include <algorithm>
#include <cmath>

namespace heel::sim {
namespace {

constexpr double kShortest_ms = 0.5;

}  // namespace

ExposureControl::ExposureControl(const ExposureSettings& settings, double exposure_ms,
                                 const std::vector<LightChange>& changes, double duration_s)
    : exposure_ms_(exposure_ms), lag_s_(settings.lag_s), changes_(changes) {
  if (!settings.automatic || exposure_ms <= 0.0) return;
  const double longest_ms = std::max(settings.longest_ms, exposure_ms);
  const double stops_down = std::log2(kShortest_ms / exposure_ms);
  const double stops_up = std::log2(longest_ms / exposure_ms * settings.most_gain);
  double stops = 0.0;  // exposure relative to that at light 1
  const int count = static_cast<int>(std::ceil(duration_s / lag_s_)) + 1;
  for (int i = 0; i < count; ++i) {
    // Each step answers the light of one step before.
    const double wanted = -std::log2(light_at((i - 1) * lag_s_));
    if (std::abs(wanted - stops) >= 0.6 * settings.step_stops)
      stops = std::clamp(stops + std::copysign(settings.step_stops, wanted - stops), stops_down, stops_up);
    Exposure step;
    step.exposure_ms = std::min(longest_ms, exposure_ms * std::exp2(stops));
    step.gain = exposure_ms * std::exp2(stops) / step.exposure_ms;
    steps_.push_back(step);
  }
}

double ExposureControl::light_at(double t_s) const {
  double level = 1.0;
  for (const LightChange& change : changes_)
    if (t_s >= change.t_s) level = change.level;
  return level;
}

Exposure ExposureControl::at(double t_s) const {
  Exposure now;
  now.exposure_ms = exposure_ms_;
  if (!steps_.empty()) {
    const double index = std::clamp(t_s / lag_s_, 0.0, static_cast<double>(steps_.size() - 1));
    now = steps_[static_cast<std::size_t>(index)];
  }
  now.light = light_at(t_s);
  return now;
}

}  // namespace heel::sim
