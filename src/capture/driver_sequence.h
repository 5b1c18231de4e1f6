// Numbers that drivers give with their frames: 32-bit sequence numbers, continued in 64 bits, and time
// stamps, checked for plausibility.
#pragma once

#include <cstdint>

#include "heel/time.h"

namespace heel {

class DriverSequence {
 public:
  /// A stream starts: the gap before its first number is 0.
  void restart() { has_last_ = false; }

  /// The number of the next frame. A number that stands still or runs backwards (a driver that does not
  /// count, or a stream that has restarted) does not mean lost frames.
  void advance(std::uint32_t driver_sequence) {
    const std::uint32_t step = driver_sequence - last_;
    const bool counts_up = has_last_ && step != 0 && step < (std::uint32_t{1} << 31);
    gap_ = counts_up ? step - 1 : 0;
    sequence_ += std::uint64_t{gap_} + 1;
    last_ = driver_sequence;
    has_last_ = true;
  }

  std::uint64_t sequence() const { return sequence_; }  ///< of the newest frame; dropped frames are counted
  std::uint32_t gap() const { return gap_; }            ///< frames missing directly before it

 private:
  std::uint64_t sequence_ = 0;
  std::uint32_t last_ = 0;
  std::uint32_t gap_ = 0;
  bool has_last_ = false;
};

/// False: the stamp lies in the future or more than a second in the past, so it is not of CLOCK_MONOTONIC.
inline bool is_plausible_stamp(TimeNs stamp_ns, TimeNs arrived_ns) {
  // Not by the difference of the two, which can overflow.
  return stamp_ns <= arrived_ns && stamp_ns >= arrived_ns - kNsPerS;
}

}  // namespace heel
