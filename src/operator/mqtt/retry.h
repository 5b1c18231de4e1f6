// When to try again what fails, and which failures are news.
#pragma once

#include <algorithm>
#include <cstddef>
#include <set>
#include <string>

#include "heel/time.h"

namespace heel {

/// The pause before the next attempt: 1 s, twice as long with each failure, at most 30 s.
class Backoff {
 public:
  TimeNs next() {
    const TimeNs pause_ns = pause_ns_;
    pause_ns_ = std::min(2 * pause_ns_, kLongest_ns);
    return pause_ns;
  }
  void reset() { pause_ns_ = kShortest_ns; }

  static constexpr TimeNs kShortest_ns = kNsPerS;
  static constexpr TimeNs kLongest_ns = 30 * kNsPerS;

 private:
  TimeNs pause_ns_ = kShortest_ns;
};

/// Each reason is news once.
class ReasonsSeen {
 public:
  /// Beyond so many different ones none is news.
  static constexpr std::size_t kMax = 16;

  bool is_news(const std::string& reason) { return seen_.size() < kMax && seen_.insert(reason).second; }
  void forget() { seen_.clear(); }

 private:
  std::set<std::string> seen_;
};

}  // namespace heel
