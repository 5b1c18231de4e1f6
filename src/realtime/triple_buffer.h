// Three slots between one writer and one reader: one is being written, one holds the newest value, one is
// being read. The slots are exchanged by a single atomic operation, so both sides are wait-free, the reader
// always gets the newest value, and neither side accesses the slot of the other.
//
// A ring of positions (slot = position mod n) would not do: when the reader is slower than the writer, as
// vision usually is behind a fast camera, the writer's position reaches the slot that the reader still holds,
// and the writer would have to drop the new value or overwrite the one being read.
//
// Memory order. All synchronisation is in newest_, which only read-modify-writes change, so each exchange
// takes the store before it and no store is lost. Both exchanges give a slot away and take one:
// - publish() releases what was written to the slot; the take() that gets the slot acquires it.
// - take() releases what was read from the slot; the publish() that gets it back acquires that: the next
//   value is not written before the old one was read.
// write_slot_ and read_slot_ each belong to one thread. has_unread() alone promises nothing about the value:
// in take() the exchange after it synchronises, and only the reader clears the flag. It acquires, so that who
// only asks sees what was done before the publish().
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

#include "realtime/memory_policy.h"

namespace heel {

inline constexpr std::size_t kCacheLineBytes = 64;

template <typename Memory = StdMemory>
class BasicTripleBuffer {
 public:
  static constexpr std::uint32_t kSlots = 3;

  // Writer:
  /// The slot that only the writer accesses until the next publish().
  std::uint32_t write_slot() const { return write_slot_; }

  /// Makes the written slot the newest value. True: it replaced a value that was never read.
  bool publish() {
    const std::uint32_t before = newest_.exchange(write_slot_ | kUnread, std::memory_order_acq_rel);
    write_slot_ = before & kSlotMask;
    return (before & kUnread) != 0;
  }

  // Reader:
  /// The slot that only the reader accesses until the next successful take().
  std::uint32_t read_slot() const { return read_slot_; }

  /// True: read_slot() is now the newest value, not taken before. False: no new value; read_slot() is
  /// unchanged.
  bool take() {
    // Only the reader clears the flag, so it is still set at the exchange.
    if (!has_unread()) return false;
    read_slot_ = newest_.exchange(read_slot_, std::memory_order_acq_rel) & kSlotMask;
    return true;
  }

  // Both:
  bool has_unread() const { return (newest_.load(std::memory_order_acquire) & kUnread) != 0; }

 private:
  static constexpr std::uint32_t kUnread = 4;  // flag: published and not yet taken
  static constexpr std::uint32_t kSlotMask = 3;

  // Each has its own cache line, so that the writer's stores do not slow down the reader's loads.
  alignas(kCacheLineBytes) typename Memory::template Atomic<std::uint32_t> newest_{0};
  alignas(kCacheLineBytes) std::uint32_t write_slot_ = 1;
  alignas(kCacheLineBytes) std::uint32_t read_slot_ = 2;
};

using TripleBuffer = BasicTripleBuffer<>;

static_assert(std::atomic<std::uint32_t>::is_always_lock_free);

}  // namespace heel
