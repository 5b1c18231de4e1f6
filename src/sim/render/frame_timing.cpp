#include "sim/render/frame_timing.h"

#include <algorithm>

#include "core/random.h"

namespace heel::sim {

FrameDelivery frame_delivery(const FrameTimingSettings& settings, std::uint64_t seed, std::uint64_t frame) {
  Random random(derived_seed(derived_seed(seed, 0x71), frame));
  FrameDelivery delivery;
  // Every number is drawn for all settings, so that one setting does not change the effect of another.
  delivery.dropped = random.uniform() < settings.drop_share;
  const bool late = random.uniform() < settings.late_share;
  const double delay_ms = settings.late_ms * (0.25 + 0.75 * random.uniform());
  if (late) delivery.delay_ns = ns_from_seconds(1e-3 * delay_ms);
  delivery.stamp_error_ns =
      ns_from_seconds(1e-3 * settings.jitter_ms * std::clamp(random.normal(), -3.0, 3.0));
  return delivery;
}

}  // namespace heel::sim
