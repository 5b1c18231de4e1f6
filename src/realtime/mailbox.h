// A mailbox for the newest value: one writer posts values, one reader gets the newest. Wait-free on both
// sides. Poses reach control through it: control must act on the newest pose and never work through a queue
// of old ones.
//
// Memory order: that of the exchange (triple_buffer.h). A slot is written between two publish() and read
// between two take(), by the side that it then belongs to.
#pragma once

#include <array>
#include <type_traits>

#include "realtime/memory_policy.h"
#include "realtime/triple_buffer.h"

namespace heel {

template <typename T, typename Memory = StdMemory>
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
    typename Memory::template Record<T> value{};
  };
  BasicTripleBuffer<Memory> exchange_;
  std::array<Slot, BasicTripleBuffer<Memory>::kSlots> values_{};
};

}  // namespace heel
