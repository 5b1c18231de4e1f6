// Limits what is sent: one command each 4 ms (the manuals ask for 3 to 5 ms), and no more bytes than the line
// carries. Commands that are repeated in every tick get at most 60 % of the line, so that a new value does
// not wait behind old ones. At 9600 baud VEL and RVEL alternate, one in each 20 ms; from 19200 baud both are
// sent.
#pragma once

#include <algorithm>
#include <cstddef>

#include "heel/time.h"

namespace heel {

class CommandPacer {
 public:
  void set_baud(int baud) { byte_ns_ = 10 * kNsPerS / baud; }

  /// True: another command may be sent, because line and controller have, or will soon have, processed the
  /// earlier ones.
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

  /// The time at which everything sent has left the line.
  TimeNs idle_from_ns() const { return busy_until_ns_; }

  void reset() { busy_until_ns_ = repeats_until_ns_ = 0; }

 private:
  static constexpr TimeNs kSpacing_ns = 4 * kNsPerMs;
  static constexpr TimeNs kBurst_ns = 12 * kNsPerMs;  // commands of one tick may wait this long in buffers
  static constexpr TimeNs kRepeatPercent = 60;
  static constexpr TimeNs kPair_ns = 8 * kNsPerMs;  // two are sent together if one uses at most this share

  TimeNs byte_ns_ = 0;
  TimeNs busy_until_ns_ = 0;
  TimeNs repeats_until_ns_ = 0;
};

}  // namespace heel
