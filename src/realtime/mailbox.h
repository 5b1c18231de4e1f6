// A mailbox for the newest value: one writer posts values, one reader gets the newest. Wait-free on both
// sides. Poses reach control through it: control must act on the newest pose and never work through a queue
// of old ones.
#pragma once

#include <array>
#include <type_traits>

#include "realtime/triple_buffer.h"

namespace heel {

template <typename T>
class Mailbox {
  static_assert(std::is_trivially_copyable_v<T>, "values are copied between threads as bytes");

 public:
  /// Writer. Replaces a value that has not been read.
  void post(const T& value) {
    values_[exchange_.write_slot()].value = value;
    exchange_.publish();
  }

  /// Reader. True: `out` is the newest value, not read before. False: no new value, `out` is unchanged.
  bool take(T& out) {
    if (!exchange_.take()) return false;
    out = values_[exchange_.read_slot()].value;
    return true;
  }

 private:
  struct alignas(kCacheLineBytes) Slot {
    T value{};
  };
  TripleBuffer exchange_;
  std::array<Slot, TripleBuffer::kSlots> values_{};
};

}  // namespace heel
