// The bytes of one tick, and the commands that wait to be sent; both in fixed memory.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "arcos/packet.h"

namespace heel {

/// The bytes that one tick sends. Large enough for everything that the pacer allows in one tick.
class OutgoingBytes {
 public:
  void clear() { size_ = 0; }
  void append(const arcos::Frame& frame) {
    std::copy(frame.bytes().begin(), frame.bytes().end(), bytes_.begin() + size_);
    size_ += frame.size();
  }
  std::span<const std::uint8_t> bytes() const { return std::span(bytes_).first(size_); }

 private:
  std::array<std::uint8_t, 512> bytes_{};
  std::size_t size_ = 0;
};

/// First in, first out.
class FrameQueue {
 public:
  bool empty() const { return count_ == 0; }
  void clear() { count_ = 0; }
  const arcos::Frame& front() const { return frames_[first_]; }
  void pop() {
    first_ = (first_ + 1) % frames_.size();
    --count_;
  }
  /// The longest sequence of the session fits; a command that does not fit, or is empty, is dropped.
  void push(const arcos::Frame& frame) {
    if (count_ == frames_.size() || frame.empty()) return;
    frames_[(first_ + count_++) % frames_.size()] = frame;
  }

 private:
  std::array<arcos::Frame, 16> frames_{};
  std::size_t first_ = 0;
  std::size_t count_ = 0;
};

}  // namespace heel
