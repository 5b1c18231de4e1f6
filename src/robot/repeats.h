// When a trouble that lasts is said again: after a minute, and each time after twice as long, an hour at
// most.
#pragma once

#include <algorithm>

#include "heel/time.h"
#include "robot/session_event.h"

namespace heel {

class Repeats {
 public:
  /// Whether it is to be said now. Another trouble than the last one is always said.
  bool is_due(SessionEventKind trouble, TimeNs now_ns) {
    if (is_said_ && trouble == trouble_ && now_ns < t_next_ns_) return false;
    pause_ns_ = is_said_ && trouble == trouble_ ? std::min(2 * pause_ns_, kLongest_ns) : kFirst_ns;
    is_said_ = true;
    trouble_ = trouble;
    t_next_ns_ = now_ns + pause_ns_;
    return true;
  }
  /// A trouble has been said, and is not over.
  bool is_said() const { return is_said_; }
  void over() { *this = {}; }

 private:
  static constexpr TimeNs kFirst_ns = 60 * kNsPerS, kLongest_ns = 3600 * kNsPerS;

  bool is_said_ = false;
  SessionEventKind trouble_ = SessionEventKind::NoAnswer;
  TimeNs t_next_ns_ = 0, pause_ns_ = 0;
};

}  // namespace heel
