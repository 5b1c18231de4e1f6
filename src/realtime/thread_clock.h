// The clock for measurements: CPU time of the calling thread. Time taken by other programs is not counted;
// their use of caches and memory still has an effect.
#pragma once

#include <ctime>

#include "heel/time.h"

namespace heel {

inline TimeNs thread_cpu_ns() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<TimeNs>(now.tv_sec) * kNsPerS + now.tv_nsec;
}

}  // namespace heel
