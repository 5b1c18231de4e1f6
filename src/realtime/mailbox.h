// A latest-wins mailbox: one writer posts values, one reader gets the newest. Wait-free on both sides.
// Poses travel through it to control: control must act on the newest pose, never work off a queue of old
// ones.
#pragma once

#include <array>
#include <type_traits>

#include "realtime/triple_buffer.h"

namespace heel {

template <typename T>
class Mailbox {
  static_assert(std::is_trivially_copyable_v<T>, "values cross threads as bytes");

 public:
  /// Writer. Replaces what has not been read yet.
  void post(const T& value) {
    values_[exchange_.write_slot()].value = value;
    exchange_.publish();
  }

  /// Reader. True: `out` is a value not read before. False: nothing new, `out` is left alone.
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
