#include "realtime/frame_triple_buffer.h"

#include <cstddef>
#include <cstring>

#include "realtime/futex.h"

namespace heel {

namespace {

std::uint32_t round_up_to_cache_line(std::uint32_t bytes) {
  constexpr auto kLine = static_cast<std::uint32_t>(kCacheLineBytes);
  return (bytes + kLine - 1) / kLine * kLine;
}

void add_one(std::atomic<std::uint64_t>& single_writer_count) {
  single_writer_count.store(single_writer_count.load(std::memory_order_relaxed) + 1,
                            std::memory_order_relaxed);
}

}  // namespace

FrameTripleBuffer::FrameTripleBuffer(std::uint32_t max_width_px, std::uint32_t max_height_px)
    : max_width_px_(max_width_px),
      max_height_px_(max_height_px),
      stride_bytes_(round_up_to_cache_line(max_width_px)) {
  const std::size_t slot_bytes = std::size_t{stride_bytes_} * max_height_px_;
  // Writing zeros also maps every page, so that the first frames cause no page faults.
  pixels_.assign(slot_bytes * TripleBuffer::kSlots + kCacheLineBytes, 0);
  const auto address = reinterpret_cast<std::uintptr_t>(pixels_.data());
  const std::size_t to_alignment = (kCacheLineBytes - address % kCacheLineBytes) % kCacheLineBytes;
  for (std::uint32_t slot = 0; slot < TripleBuffer::kSlots; ++slot) {
    slot_pixels_[slot] = pixels_.data() + to_alignment + slot * slot_bytes;
    slots_[slot].grey = slot_pixels_[slot];
    slots_[slot].stride_bytes = stride_bytes_;
  }
}

WritableFrame FrameTripleBuffer::writable() {
  const std::uint32_t slot = exchange_.write_slot();
  return {&slots_[slot].header, slot_pixels_[slot], stride_bytes_};
}

void FrameTripleBuffer::publish() {
  add_one(captured_);
  if (exchange_.publish()) add_one(dropped_);
  wake();
}

bool FrameTripleBuffer::push(const FrameView& frame) {
  if (frame.header.width_px > max_width_px_ || frame.header.height_px > max_height_px_) return false;
  const WritableFrame slot = writable();
  *slot.header = frame.header;
  for (std::uint32_t y = 0; y < frame.header.height_px; ++y) {
    std::memcpy(slot.grey + std::size_t{y} * slot.stride_bytes,
                frame.grey + std::size_t{y} * frame.stride_bytes, frame.header.width_px);
  }
  publish();
  return true;
}

const FrameView* FrameTripleBuffer::take() {
  if (!exchange_.take()) return nullptr;
  add_one(consumed_);
  return &slots_[exchange_.read_slot()];
}

bool FrameTripleBuffer::wait(TimeNs timeout_ns) const {
  // The signal is read before the check for a frame: a frame published between the check and the sleep
  // changes the signal, and the futex then returns at once.
  const std::uint32_t seen = signal_.load(std::memory_order_acquire);
  if (exchange_.has_unread()) return true;
  futex_wait(signal_, seen, timeout_ns, FutexScope::Process);
  return exchange_.has_unread();
}

void FrameTripleBuffer::wake() {
  signal_.fetch_add(1, std::memory_order_release);
  futex_wake_all(signal_, FutexScope::Process);
}

}  // namespace heel
