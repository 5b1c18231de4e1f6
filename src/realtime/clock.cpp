#include "realtime/clock.h"

#include <cerrno>
#include <ctime>

namespace heel {

TimeNs monotonic_now_ns() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<TimeNs>(now.tv_sec) * kNsPerS + now.tv_nsec;
}

void sleep_until_ns(TimeNs t_ns) {
  const timespec until{.tv_sec = t_ns / kNsPerS, .tv_nsec = t_ns % kNsPerS};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

PeriodicDeadline::PeriodicDeadline(TimeNs period_ns, TimeNs start_ns)
    : period_ns_(period_ns), next_ns_(start_ns + period_ns) {}

TimeNs PeriodicDeadline::advance(TimeNs now_ns) {
  const TimeNs lateness_ns = now_ns > next_ns_ ? now_ns - next_ns_ : 0;
  const TimeNs missed = lateness_ns / period_ns_;
  overruns_ += static_cast<std::uint64_t>(missed);
  next_ns_ += (missed + 1) * period_ns_;
  return lateness_ns;
}

}  // namespace heel
