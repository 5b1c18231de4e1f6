// How long a camera may be silent before it counts as stalled.
#pragma once

#include <algorithm>

#include "heel/time.h"

namespace heel {

/// Between frames: 2 s. From the opening to the first frame longer, because some cameras need 3 s to start,
/// and twice as long after each opening that gave no frame: 4, 8, then 16 s.
class StallWatch {
 public:
  static constexpr TimeNs kBetweenFrames_ns = 2 * kNsPerS;
  static constexpr TimeNs kFirstFrame_ns = 4 * kNsPerS;
  static constexpr TimeNs kLongest_ns = 16 * kNsPerS;

  void opened(TimeNs now_ns) {
    allowed_ns_ = first_ns_;
    first_ns_ = std::min(2 * first_ns_, kLongest_ns);
    t_last_ns_ = now_ns;
  }
  void frame(TimeNs now_ns) {
    allowed_ns_ = kBetweenFrames_ns;
    first_ns_ = kFirstFrame_ns;
    t_last_ns_ = now_ns;
  }
  bool stalled(TimeNs now_ns) const { return now_ns - t_last_ns_ > allowed_ns_; }
  TimeNs allowed_ns() const { return allowed_ns_; }

 private:
  TimeNs first_ns_ = kFirstFrame_ns;  // of the next opening
  TimeNs allowed_ns_ = kFirstFrame_ns;
  TimeNs t_last_ns_ = 0;
};

}  // namespace heel
