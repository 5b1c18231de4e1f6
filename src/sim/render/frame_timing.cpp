#include "sim/render/frame_timing.h"

#include <algorithm>

#include "core/random.h"

namespace heel::sim {

FrameFate frame_fate(const FrameTimingSettings& settings, std::uint64_t seed, std::uint64_t frame) {
  Random random(derived_seed(derived_seed(seed, 0x71), frame));
  FrameFate fate;
  // Every number is drawn whatever the settings: one setting does not change what another does.
  fate.dropped = random.uniform() < settings.drop_share;
  const bool late = random.uniform() < settings.late_share;
  const double delay_ms = settings.late_ms * (0.25 + 0.75 * random.uniform());
  if (late) fate.delay_ns = ns_from_seconds(1e-3 * delay_ms);
  fate.stamp_error_ns = ns_from_seconds(1e-3 * settings.jitter_ms * std::clamp(random.normal(), -3.0, 3.0));
  return fate;
}

}  // namespace heel::sim
