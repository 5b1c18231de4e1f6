// How much may be sent now: a command each 4 ms (manuals ask for 3–5), and no more bytes than the line
// carries; of commands that are repeated anyway no more than 60 % of it, so that a new value never waits
// behind old ones. At 9600 baud that is VEL and RVEL in turn, one in each 20 ms; from 19200 baud both.
#pragma once

#include <algorithm>
#include <cstddef>

#include "heel/time.h"

namespace heel {

class CommandPacer {
 public:
  void set_baud(int baud) { byte_ns_ = 10 * kNsPerS / baud; }

  /// Another command may go: what was sent before is, or will soon be, through line and controller.
  bool may_send(TimeNs now_ns) const { return busy_until_ns_ <= now_ns + kBurst_ns; }

  /// The same for a command that is repeated in every tick.
  bool may_repeat(TimeNs now_ns) const { return may_send(now_ns) && repeats_until_ns_ <= now_ns + kPair_ns; }

  void sent(std::size_t bytes, TimeNs now_ns) {
    const TimeNs cost_ns = std::max(kSpacing_ns, static_cast<TimeNs>(bytes) * byte_ns_);
    busy_until_ns_ = std::max(busy_until_ns_, now_ns) + cost_ns;
  }
  void repeated(std::size_t bytes, TimeNs now_ns) {
    sent(bytes, now_ns);
    const TimeNs cost_ns = static_cast<TimeNs>(bytes) * byte_ns_ * 100 / kRepeatPercent;
    repeats_until_ns_ = std::max(repeats_until_ns_, now_ns) + cost_ns;
  }

  /// By then everything sent is through the line.
  TimeNs idle_from_ns() const { return busy_until_ns_; }

  void reset() { busy_until_ns_ = repeats_until_ns_ = 0; }

 private:
  static constexpr TimeNs kSpacing_ns = 4 * kNsPerMs;
  static constexpr TimeNs kBurst_ns = 12 * kNsPerMs;  // written in one tick, they wait their turn in buffers
  static constexpr TimeNs kRepeatPercent = 60;
  static constexpr TimeNs kPair_ns = 8 * kNsPerMs;  // two at once where one takes no longer of its share

  TimeNs byte_ns_ = 0;
  TimeNs busy_until_ns_ = 0;
  TimeNs repeats_until_ns_ = 0;
};

}  // namespace heel
