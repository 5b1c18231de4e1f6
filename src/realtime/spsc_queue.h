// A bounded queue of records from one real-time thread to the telemetry thread. Wait-free on both sides.
// When it is full, the new record is dropped and counted: the real-time thread never waits for a slow disk.
//
// Memory order. Each position is stored by one thread only; that thread loads it relaxed, since it sees its
// own stores.
// - The writer fills the slot, then stores tail_ with release; the reader loads tail_ with acquire, then
//   reads the slot: it sees the whole record.
// - The reader reads the slot, then stores head_ with release; the writer loads head_ with acquire, then
//   fills the slot again: the old record was read before.
// The copies of the other's position may be old. An old tail hides records, an old head hides room; neither
// lets a side into a slot of the other. dropped_ orders nothing: it is a number to look at.
#pragma once

#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "realtime/memory_policy.h"
#include "realtime/triple_buffer.h"

namespace heel {

template <typename T, typename Memory = StdMemory>
class SpscQueue {
  static_assert(std::is_trivially_copyable_v<T>, "records are copied between threads as bytes");

 public:
  /// Allocates all memory here. The capacity is rounded up to a power of two.
  explicit SpscQueue(std::size_t capacity)
      : records_(std::bit_ceil(capacity < 2 ? std::size_t{2} : capacity)), mask_(records_.size() - 1) {}

  SpscQueue(const SpscQueue&) = delete;
  SpscQueue& operator=(const SpscQueue&) = delete;

  /// Writer. False: the queue is full; the record was dropped and counted.
  bool push(const T& record) {
    const std::uint64_t tail = tail_.load(std::memory_order_relaxed);
    if (tail - cached_head_ == records_.size()) {
      cached_head_ = head_.load(std::memory_order_acquire);
      if (tail - cached_head_ == records_.size()) {
        dropped_.store(dropped_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
        return false;
      }
    }
    records_[tail & mask_] = record;
    tail_.store(tail + 1, std::memory_order_release);
    return true;
  }

  /// Reader. Oldest first; false: empty.
  bool pop(T& out) {
    const std::uint64_t head = head_.load(std::memory_order_relaxed);
    if (head == cached_tail_) {
      cached_tail_ = tail_.load(std::memory_order_acquire);
      if (head == cached_tail_) return false;
    }
    out = records_[head & mask_];
    head_.store(head + 1, std::memory_order_release);
    return true;
  }

  std::size_t capacity() const { return records_.size(); }
  /// Records lost since construction because the reader was too slow. Any thread.
  std::uint64_t dropped() const { return dropped_.load(std::memory_order_relaxed); }

 private:
  template <typename Value>
  using Atomic = typename Memory::template Atomic<Value>;

  std::vector<typename Memory::template Record<T>> records_;
  std::size_t mask_;

  // Positions only count up. Each side keeps a copy of the other's position and reads it again only when the
  // copy says full (or empty). In steady flow the two sides then do not access each other's cache line.
  alignas(kCacheLineBytes) Atomic<std::uint64_t> tail_{0};  // written by the writer
  std::uint64_t cached_head_ = 0;
  Atomic<std::uint64_t> dropped_{0};
  alignas(kCacheLineBytes) Atomic<std::uint64_t> head_{0};  // written by the reader
  std::uint64_t cached_tail_ = 0;
};

}  // namespace heel
