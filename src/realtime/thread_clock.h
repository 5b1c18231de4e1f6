// The clock of the measurements: CPU time of the calling thread. What other programs on the machine take does
// not count, but for what their use of caches and memory costs.
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
