// The time of day, for people; everything else counts by the monotonic clock.
#pragma once

#include <chrono>

#include "heel/time.h"

namespace heel {

/// Since 1970.
inline TimeNs wall_now_ns() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::nanoseconds>(now).count();
}

}  // namespace heel
