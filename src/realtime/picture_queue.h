// Copies of frames from one thread to another, first in, first out, in memory of fixed size. Wait-free on
// both sides. When it is full, the new frame is dropped and counted.
//
// Memory order: as in spsc_queue.h, but that the reader keeps the slot from front() to pop(). The writer's
// release of tail_ publishes header and pixels; the reader's release of head_ in pop() gives back the slot
// that it has left, and the writer acquires head_ before each push. open_ and dropped_ order nothing: a frame
// more or less while the queue is closed does no harm.
#pragma once

#include <atomic>
#include <cstdint>
#include <cstring>
#include <vector>

#include "heel/flow.h"
#include "realtime/memory_policy.h"
#include "realtime/triple_buffer.h"

namespace heel {

template <typename Memory = StdMemory>
class BasicPictureQueue {
 public:
  /// Allocates all memory here, for frames of at most this size.
  BasicPictureQueue(std::size_t frames, std::uint32_t max_width_px, std::uint32_t max_height_px)
      : slot_bytes_(std::size_t{max_width_px} * max_height_px),
        headers_(frames),
        pixels_(frames * slot_bytes_) {}

  BasicPictureQueue(const BasicPictureQueue&) = delete;
  BasicPictureQueue& operator=(const BasicPictureQueue&) = delete;

  /// Any thread. While it is closed, frames are neither copied nor counted.
  void set_open(bool open) { open_.store(open, std::memory_order_relaxed); }

  /// Writer. False: the queue is closed or full, or the frame is larger than its slots; it was dropped and
  /// counted.
  bool push(const FrameView& frame) {
    if (!open_.load(std::memory_order_relaxed)) return false;
    const FrameHeader& header = frame.header;
    const std::uint64_t tail = tail_.load(std::memory_order_relaxed);
    const bool full = tail - head_.load(std::memory_order_acquire) == headers_.size();
    if (full || std::size_t{header.width_px} * header.height_px > slot_bytes_) {
      dropped_.store(dropped_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
      return false;
    }
    std::uint8_t* const slot = pixels_.data() + (tail % headers_.size()) * slot_bytes_;
    for (std::uint32_t row = 0; row < header.height_px; ++row)
      std::memcpy(slot + std::size_t{row} * header.width_px,
                  frame.grey + std::size_t{row} * frame.stride_bytes, header.width_px);
    headers_[tail % headers_.size()] = header;
    tail_.store(tail + 1, std::memory_order_release);
    return true;
  }

  /// Reader. The oldest frame, valid until pop(); null pixels: there is none.
  FrameView front() const {
    const std::uint64_t head = head_.load(std::memory_order_relaxed);
    if (head == tail_.load(std::memory_order_acquire)) return {};
    const FrameHeader header = headers_[head % headers_.size()];
    return {header, pixels_.data() + (head % headers_.size()) * slot_bytes_, header.width_px};
  }
  void pop() { head_.store(head_.load(std::memory_order_relaxed) + 1, std::memory_order_release); }

  /// Any thread.
  std::uint64_t dropped() const { return dropped_.load(std::memory_order_relaxed); }

 private:
  template <typename Value>
  using Atomic = typename Memory::template Atomic<Value>;

  const std::size_t slot_bytes_;
  std::vector<typename Memory::template Record<FrameHeader>> headers_;
  std::vector<std::uint8_t> pixels_;
  Atomic<bool> open_{true};
  // Positions only count up.
  alignas(kCacheLineBytes) Atomic<std::uint64_t> tail_{0};  // written by the writer
  Atomic<std::uint64_t> dropped_{0};
  alignas(kCacheLineBytes) Atomic<std::uint64_t> head_{0};  // written by the reader
};

using PictureQueue = BasicPictureQueue<>;

}  // namespace heel
