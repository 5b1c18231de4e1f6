// Three slots that change hands between one writer and one reader: one is being written, one holds the newest
// value, one is being read. Handing over is a single atomic exchange, so both sides are wait-free, the reader
// always gets the newest value, and neither side ever touches a slot the other one holds.
//
// Why not a ring of positions (slot = position mod n)? A reader that is slower than the writer (vision behind
// a fast camera is the ordinary case) still holds its slot when the writer's position comes round to it; the
// writer would have to drop the fresh value or tear the held one. Slots that change hands have no such place.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

namespace heel {

inline constexpr std::size_t kCacheLineBytes = 64;

class TripleBuffer {
 public:
  static constexpr std::uint32_t kSlots = 3;

  // ── writer ──
  /// The slot only the writer touches until the next publish.
  std::uint32_t write_slot() const { return write_slot_; }

  /// Makes the written slot the newest. True: it overtook a value nobody had read.
  bool publish() {
    // Release: the reader that takes the slot sees what was written into it.
    // Acquire: what the reader did with the slot we get back is over before we write there.
    const std::uint32_t before = newest_.exchange(write_slot_ | kFresh, std::memory_order_acq_rel);
    write_slot_ = before & kSlotMask;
    return (before & kFresh) != 0;
  }

  // ── reader ──
  /// The slot only the reader touches until the next successful take.
  std::uint32_t read_slot() const { return read_slot_; }

  /// True: read_slot() is now the newest value, not taken before. False: nothing new, the slot held stays.
  bool take() {
    // Only the reader clears the mark, so what the load saw cannot have gone before the exchange.
    if (!has_fresh()) return false;
    read_slot_ = newest_.exchange(read_slot_, std::memory_order_acq_rel) & kSlotMask;
    return true;
  }

  // ── either ──
  bool has_fresh() const { return (newest_.load(std::memory_order_acquire) & kFresh) != 0; }

 private:
  static constexpr std::uint32_t kFresh = 4;  // published and not yet taken
  static constexpr std::uint32_t kSlotMask = 3;

  // Each on its own cache line: the writer's stores do not slow the reader's loads.
  alignas(kCacheLineBytes) std::atomic<std::uint32_t> newest_{0};
  alignas(kCacheLineBytes) std::uint32_t write_slot_ = 1;
  alignas(kCacheLineBytes) std::uint32_t read_slot_ = 2;
};

static_assert(std::atomic<std::uint32_t>::is_always_lock_free);

}  // namespace heel
