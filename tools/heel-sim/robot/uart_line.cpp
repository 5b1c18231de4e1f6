#include "heel-sim/robot/uart_line.h"

#include <algorithm>

namespace heel::sim {
namespace {

constexpr int kBitsPerFrame = 10;  // start, eight data bits (lowest first), stop

/// Time of `half_bits` half bit times at `baud`.
TimeNs half_bits_ns(int half_bits, int baud) {
  return half_bits * (kNsPerS / 2) / baud;
}
TimeNs bits_ns(int bits, int baud) {
  return half_bits_ns(2 * bits, baud);
}

/// Level of bit `index` of a frame: 0 is the start bit, 9 the stop bit.
bool bit_level(std::uint8_t byte, int index) {
  if (index == 0) return false;
  if (index == kBitsPerFrame - 1) return true;
  return ((byte >> (index - 1)) & 1) != 0;
}

}  // namespace

void UartLine::send(std::span<const std::uint8_t> bytes, TimeNs t_ns) {
  t_free_ns_ = std::max(t_free_ns_, t_ns);
  for (const std::uint8_t byte : bytes) {
    frames_.push_back({t_free_ns_, sender_baud_, byte});
    t_free_ns_ += bits_ns(kBitsPerFrame, sender_baud_);
  }
}

void UartLine::receive_until(TimeNs t_ns, std::vector<std::uint8_t>& out) {
  for (;;) {
    while (!frames_.empty() &&
           frames_.front().t_start_ns + bits_ns(kBitsPerFrame, frames_.front().baud) <= t_search_ns_) {
      frames_.pop_front();
    }
    const Edge start = next_falling_edge();
    const TimeNs t_done_ns = start.t_ns + half_bits_ns(2 * kBitsPerFrame - 1, receiver_baud_);
    if (!start.found || t_done_ns > t_ns) return;
    const TimeNs t_mid_start_ns = start.t_ns + half_bits_ns(1, receiver_baud_);
    if (level_at(t_mid_start_ns)) {  // a glitch, shorter than half a start bit
      t_search_ns_ = t_mid_start_ns;
      continue;
    }
    unsigned byte = 0;
    for (int bit = 0; bit < 8; ++bit) {
      if (level_at(start.t_ns + half_bits_ns(2 * bit + 3, receiver_baud_))) byte |= 1u << bit;
    }
    out.push_back(static_cast<std::uint8_t>(byte));  // a missing stop bit is not told, as a tty does not
    t_search_ns_ = t_done_ns;
  }
}

void UartLine::clear() {
  frames_.clear();
  t_free_ns_ = 0;
}

UartLine::Edge UartLine::next_falling_edge() const {
  bool before = level_at(t_search_ns_ - 1);
  TimeNs t_end_of_frame_ns = t_search_ns_;
  for (const Frame& frame : frames_) {
    if (frame.t_start_ns > t_end_of_frame_ns) before = true;  // the line idled
    for (int bit = 0; bit < kBitsPerFrame; ++bit) {
      const TimeNs t_ns = frame.t_start_ns + bits_ns(bit, frame.baud);
      if (t_ns < t_search_ns_) continue;
      const bool level = bit_level(frame.byte, bit);
      if (before && !level) return {true, t_ns};
      before = level;
    }
    t_end_of_frame_ns = std::max(t_end_of_frame_ns, frame.t_start_ns + bits_ns(kBitsPerFrame, frame.baud));
  }
  return {false, 0};
}

bool UartLine::level_at(TimeNs t_ns) const {
  for (const Frame& frame : frames_) {
    if (t_ns < frame.t_start_ns) return true;
    for (int bit = kBitsPerFrame - 1; bit >= 0; --bit) {
      if (t_ns < frame.t_start_ns + bits_ns(bit, frame.baud)) continue;
      if (bit == kBitsPerFrame - 1 && t_ns >= frame.t_start_ns + bits_ns(kBitsPerFrame, frame.baud)) break;
      return bit_level(frame.byte, bit);
    }
  }
  return true;
}

}  // namespace heel::sim
