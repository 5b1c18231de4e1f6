// What drivers say of their frames, made sound: 32-bit sequence counts carried on in 64 bits, and time stamps
// that can be believed.
#pragma once

#include <cstdint>

#include "heel/time.h"

namespace heel {

class DriverCount {
 public:
  /// A stream begins anew: its first count is no gap.
  void restart() { has_last_ = false; }

  /// The next frame's count. A count that stands still or runs backwards (drivers that do not count, streams
  /// that began anew) says nothing of lost frames.
  void advance(std::uint32_t driver_sequence) {
    const std::uint32_t step = driver_sequence - last_;
    const bool sound = has_last_ && step != 0 && step < (std::uint32_t{1} << 31);
    gap_ = sound ? step - 1 : 0;
    sequence_ += std::uint64_t{gap_} + 1;
    last_ = driver_sequence;
    has_last_ = true;
  }

  std::uint64_t sequence() const { return sequence_; }  ///< of the frame counted last, dropped ones included
  std::uint32_t gap() const { return gap_; }            ///< frames missing right before it

 private:
  std::uint64_t sequence_ = 0;
  std::uint32_t last_ = 0;
  std::uint32_t gap_ = 0;
  bool has_last_ = false;
};

/// False: the stamp lies in the future or more than a second back, and cannot be of CLOCK_MONOTONIC.
inline bool is_believable_stamp(TimeNs stamp_ns, TimeNs arrived_ns) {
  // Not by the difference of the two, which can overflow.
  return stamp_ns <= arrived_ns && stamp_ns >= arrived_ns - kNsPerS;
}

}  // namespace heel
