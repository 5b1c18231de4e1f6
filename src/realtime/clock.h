// The one clock of the daemon's threads, sleeping to absolute times on it, and a periodic deadline.
// Stages never include this: they are handed the time.
#pragma once

#include <cstdint>

#include "heel/time.h"

namespace heel {

/// CLOCK_MONOTONIC.
TimeNs monotonic_now_ns();

/// Sleeps to an absolute time (so that the time a loop's body takes does not add up); at once when past.
void sleep_until_ns(TimeNs t_ns);

/// A fixed rate kept by absolute deadlines: start + k · period.
class PeriodicDeadline {
 public:
  /// The first deadline is one period after `start_ns`.
  PeriodicDeadline(TimeNs period_ns, TimeNs start_ns);
  /// Moves the start. A thread calls this first, so that the time before it ran does not count as lateness.
  void restart(TimeNs start_ns) { next_ns_ = start_ns + period_ns_; }

  TimeNs period_ns() const { return period_ns_; }
  TimeNs next_ns() const { return next_ns_; }
  std::uint64_t overruns() const { return overruns_; }

  /// Sleeps to the next deadline and moves on to the one after. Returns how late it woke, ≥ 0.
  TimeNs wait();

  /// What wait() does after waking at `now_ns`, without the sleep. Deadlines that have passed altogether are
  /// skipped and counted as overruns: a loop that was held up does not run the missed ticks in a burst.
  TimeNs advance(TimeNs now_ns);

 private:
  TimeNs period_ns_;
  TimeNs next_ns_;
  std::uint64_t overruns_ = 0;
};

}  // namespace heel
