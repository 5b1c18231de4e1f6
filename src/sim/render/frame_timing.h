// When a frame comes, and what time is written on it: dropped frames, late frames, a clock that jitters.
#pragma once

#include <cstdint>

#include "heel/time.h"

namespace heel::sim {

struct FrameTimingSettings {
  double drop_share = 0.0;  ///< frames that never come
  double late_share = 0.0;  ///< frames held up on the way, stamped with their true time all the same
  double late_ms = 60.0;    ///< for up to this long
  double jitter_ms = 0.0;   ///< of the time stamp, one standard deviation, at most three
};

struct FrameFate {
  bool dropped = false;
  TimeNs delay_ns = 0;        ///< beyond the end of the exposure
  TimeNs stamp_error_ns = 0;  ///< stamped minus true time
};

/// A function of its arguments only.
FrameFate frame_fate(const FrameTimingSettings& settings, std::uint64_t seed, std::uint64_t frame);

}  // namespace heel::sim
