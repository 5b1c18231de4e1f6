// The clock of the daemon's threads, sleeping until an absolute time on it, and a periodic deadline.
// Stages do not include this: they receive the time as an argument.
#pragma once

#include <cstdint>

#include "heel/time.h"

namespace heel {

/// CLOCK_MONOTONIC.
TimeNs monotonic_now_ns();

/// Sleeps until an absolute time, so that the run time of a loop's body does not add up. Returns at once when
/// that time is past.
void sleep_until_ns(TimeNs t_ns);

/// A fixed rate by absolute deadlines: start + k · period.
class PeriodicDeadline {
 public:
  /// The first deadline is one period after `start_ns`.
  PeriodicDeadline(TimeNs period_ns, TimeNs start_ns);
  /// Moves the start. A thread calls this first, so that the time before it ran does not count as lateness.
  void restart(TimeNs start_ns) { next_ns_ = start_ns + period_ns_; }

  TimeNs next_ns() const { return next_ns_; }
  std::uint64_t overruns() const { return overruns_; }

  /// To be called after waking at `now_ns`: moves on to the next deadline that has not passed. Returns how
  /// late the wake-up was, ≥ 0. Whole periods that have passed are skipped and counted as overruns: a loop
  /// that was delayed does not run the missed ticks in a burst.
  TimeNs advance(TimeNs now_ns);

 private:
  TimeNs period_ns_;
  TimeNs next_ns_;
  std::uint64_t overruns_ = 0;
};

}  // namespace heel
