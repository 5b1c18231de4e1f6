// Errors of a camera's frame timing: dropped frames, late frames, time stamps that jitter.
#pragma once

#include <cstdint>

#include "heel/time.h"

namespace heel::sim {

struct FrameTimingSettings {
  double drop_share = 0.0;  ///< share of frames that are lost
  double late_share = 0.0;  ///< share of frames that arrive late; their time stamp is right
  double late_ms = 60.0;    ///< the longest delay of a late frame
  double jitter_ms = 0.0;   ///< standard deviation of the time stamp's error, which stays below three of them
};

/// How one frame reaches the reader.
struct FrameDelivery {
  bool dropped = false;
  TimeNs delay_ns = 0;        ///< after the end of the exposure
  TimeNs stamp_error_ns = 0;  ///< stamped minus true time
};

/// Depends on its arguments only.
FrameDelivery frame_delivery(const FrameTimingSettings& settings, std::uint64_t seed, std::uint64_t frame);

}  // namespace heel::sim
