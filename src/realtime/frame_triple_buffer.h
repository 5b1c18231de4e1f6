// Frames from the capture thread to the vision thread, preallocated and lock-free. One writer, one reader.
// The reader always gets the newest complete frame. A frame that a newer one replaces before it was read is
// dropped and counted. The frame that the reader holds is never overwritten.
//
// When neither side is in a call:  captured = consumed + dropped + (1 if a frame is unread, else 0).
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

#include "heel/flow.h"
#include "realtime/triple_buffer.h"

namespace heel {

/// A slot for the writer to fill.
struct WritableFrame {
  FrameHeader* header = nullptr;
  std::uint8_t* grey = nullptr;
  std::uint32_t stride_bytes = 0;
};

class FrameTripleBuffer {
 public:
  /// Allocates all memory here, for frames of at most this size.
  FrameTripleBuffer(std::uint32_t max_width_px, std::uint32_t max_height_px);

  FrameTripleBuffer(const FrameTripleBuffer&) = delete;
  FrameTripleBuffer& operator=(const FrameTripleBuffer&) = delete;

  std::uint32_t max_width_px() const { return max_width_px_; }
  std::uint32_t max_height_px() const { return max_height_px_; }

  // Writer:
  /// The slot to fill; it stays the same until publish().
  WritableFrame writable();
  /// Makes the filled slot the newest frame and wakes the reader.
  void publish();
  /// Copies a frame and publishes it. False: the frame is too large and was not copied.
  bool push(const FrameView& frame);

  // Reader:
  /// The newest frame, or null if it has been taken before. It stays valid and unchanged until the next
  /// take() that returns a frame.
  const FrameView* take();
  /// Sleeps until a frame can be taken (true), or until the timeout or wake() (false).
  bool wait(TimeNs timeout_ns) const;

  // Any thread:
  /// Ends a wait() early, e.g. to stop the reader's thread.
  void wake();
  std::uint64_t captured() const { return captured_.load(std::memory_order_relaxed); }
  std::uint64_t dropped() const { return dropped_.load(std::memory_order_relaxed); }
  std::uint64_t consumed() const { return consumed_.load(std::memory_order_relaxed); }

 private:
  std::uint32_t max_width_px_;
  std::uint32_t max_height_px_;
  std::uint32_t stride_bytes_;
  std::vector<std::uint8_t> pixels_;  // of all slots
  std::array<FrameView, TripleBuffer::kSlots> slots_;
  std::array<std::uint8_t*, TripleBuffer::kSlots> slot_pixels_{};

  TripleBuffer exchange_;
  alignas(kCacheLineBytes) std::atomic<std::uint64_t> captured_{0};  // written by the writer
  std::atomic<std::uint64_t> dropped_{0};                            // written by the writer
  std::atomic<std::uint32_t> signal_{0};                             // changes with every publish and wake
  alignas(kCacheLineBytes) std::atomic<std::uint64_t> consumed_{0};  // written by the reader
};

}  // namespace heel
