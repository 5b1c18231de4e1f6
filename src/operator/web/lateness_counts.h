// How late the control ticks were, counted in steps: a histogram that one thread fills and any thread reads.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "heel/time.h"

namespace heel {

class LatenessCounts {
 public:
  /// Upper ends of the steps; one more has all that is later.
  static constexpr std::array<TimeNs, 10> kBounds_ns{
      20'000, 50'000, 100'000, 200'000, 500'000, 1'000'000, 2'000'000, 5'000'000, 20'000'000, 100'000'000};
  struct Values {
    std::array<std::uint64_t, kBounds_ns.size() + 1> counts{};
    TimeNs sum_ns = 0;
  };

  void add(TimeNs lateness_ns) {
    std::size_t step = 0;
    while (step < kBounds_ns.size() && lateness_ns > kBounds_ns[step]) ++step;
    counts_[step].fetch_add(1, std::memory_order_relaxed);
    sum_ns_.fetch_add(lateness_ns, std::memory_order_relaxed);
  }
  Values values() const {
    Values values;
    for (std::size_t i = 0; i < counts_.size(); ++i)
      values.counts[i] = counts_[i].load(std::memory_order_relaxed);
    values.sum_ns = sum_ns_.load(std::memory_order_relaxed);
    return values;
  }

 private:
  std::array<std::atomic<std::uint64_t>, kBounds_ns.size() + 1> counts_{};
  std::atomic<TimeNs> sum_ns_{0};
};

}  // namespace heel
