#include "sim/robot/uart_line.h"

#include <algorithm>

namespace heel::sim {
namespace {

constexpr int kBitsPerFrame = 10;  // start, eight data bits (lowest first), stop

/// Duration of `half_bits` half bits at `baud`.
TimeNs half_bits_ns(int half_bits, int baud) {
  return half_bits * (kNsPerS / 2) / baud;
}
TimeNs bits_ns(int bits, int baud) {
  return half_bits_ns(2 * bits, baud);
}

/// The first bit that begins `dt_ns` or more after the start of its frame. A bit begins at floor(bit · 1e9 /
/// baud).
int first_bit_from(TimeNs dt_ns, int baud) {
  if (dt_ns <= 0) return 0;
  return static_cast<int>((dt_ns * baud + kNsPerS - 1) / kNsPerS);
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
    const TimeNs t_end_ns = t_free_ns_ + bits_ns(kBitsPerFrame, sender_baud_);
    frames_.push_back({t_free_ns_, t_end_ns, sender_baud_, byte});
    t_free_ns_ = t_end_ns;
  }
}

void UartLine::receive_until(TimeNs t_ns, std::vector<std::uint8_t>& out) {
  for (;;) {
    while (!frames_.empty() && frames_.front().t_end_ns <= t_search_ns_) frames_.pop_front();
    if (frames_.empty()) return;  // an idle line has no edge
    const Edge start = next_falling_edge();
    const TimeNs t_done_ns = start.t_ns + half_bits_ns(2 * kBitsPerFrame - 1, receiver_baud_);
    if (!start.found || t_done_ns > t_ns) return;
    const TimeNs t_mid_start_ns = start.t_ns + half_bits_ns(1, receiver_baud_);
    if (level_at(t_mid_start_ns)) {  // a glitch: shorter than half a start bit
      t_search_ns_ = t_mid_start_ns;
      continue;
    }
    unsigned byte = 0;
    for (int bit = 0; bit < 8; ++bit) {
      if (level_at(start.t_ns + half_bits_ns(2 * bit + 3, receiver_baud_))) byte |= 1u << bit;
    }
    out.push_back(static_cast<std::uint8_t>(byte));  // a missing stop bit is not reported, as by a tty
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
    if (frame.t_start_ns > t_end_of_frame_ns) before = true;  // the line was idle
    for (int bit = first_bit_from(t_search_ns_ - frame.t_start_ns, frame.baud); bit < kBitsPerFrame; ++bit) {
      const bool level = bit_level(frame.byte, bit);
      if (before && !level) return {true, frame.t_start_ns + bits_ns(bit, frame.baud)};
      before = level;
    }
    t_end_of_frame_ns = std::max(t_end_of_frame_ns, frame.t_end_ns);
  }
  return {false, 0};
}

bool UartLine::level_at(TimeNs t_ns) const {
  for (const Frame& frame : frames_) {
    if (t_ns < frame.t_start_ns) return true;
    if (t_ns >= frame.t_end_ns) continue;
    // The last bit that has begun is the one before the first that begins later.
    return bit_level(frame.byte, first_bit_from(t_ns + 1 - frame.t_start_ns, frame.baud) - 1);
  }
  return true;
}

}  // namespace heel::sim
