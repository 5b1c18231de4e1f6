// Frames between processes: the simulator's camera writes them into POSIX shared memory "/heel-sim-NAME",
// the daemon's sim source (and anyone else, read-only) reads the newest.
//
//   SimChannelWriter writer("yard", 640, 480);      // the producer, e.g. tools/heel-sim
//   WritableFrame slot = writer.writable();         // fill *slot.header and slot.grey, then
//   writer.publish();
//
// Layout: one SimChannelHeader, then kSimSlots slots of `slot_bytes` each: a SimSlotHeader and the pixels.
// Frame number n (from 1) goes into slot n mod kSimSlots under that slot's sequence lock: odd while it is
// written, 2n when whole. Readers copy a slot and keep the copy only if the lock did not move meanwhile.
//
// Life and death: the writer holds flock(LOCK_EX) on its segment, so the kernel tells a living writer from a
// killed one; each writer makes a new segment, so a reader of an old one sees that the name has moved on.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "heel/flow.h"
#include "realtime/frame_triple_buffer.h"

namespace heel {

inline constexpr std::uint32_t kSimChannelMagic = 0x4c454548;  // "HEEL", little-endian
inline constexpr std::uint32_t kSimChannelVersion = 1;
inline constexpr std::uint32_t kSimSlots = 4;
inline constexpr std::uint32_t kWordBytes = 8;  ///< pixels travel in words, each stored and loaded at once

struct SimChannelHeader {
  std::atomic<std::uint32_t> magic;  ///< written last: the segment is ready
  std::uint32_t version;
  std::uint32_t slots;
  std::uint32_t max_width_px;
  std::uint32_t max_height_px;
  std::uint32_t stride_bytes;
  std::uint64_t slot_bytes;
  std::uint64_t total_bytes;
  std::atomic<std::uint32_t> published;  ///< number of the newest frame; readers wait on it as a futex
  std::atomic<std::uint32_t> closed;     ///< 1: the writer has ended in good order
  std::uint8_t reserved[16];
};
static_assert(sizeof(SimChannelHeader) == 64);

struct SimSlotHeader {
  std::atomic<std::uint64_t> lock;  ///< odd: being written; 2n: holds frame n whole
  std::atomic<std::uint64_t> sequence;
  std::atomic<std::int64_t> t_capture_ns;  ///< CLOCK_MONOTONIC
  std::atomic<std::uint32_t> width_px;
  std::atomic<std::uint32_t> height_px;
  std::uint8_t reserved[32];
};
static_assert(sizeof(SimSlotHeader) == 64);

/// "/heel-sim-NAME". Throws heel::Error unless NAME is 1 to 64 letters, digits, '-', '_' or '.'.
std::string sim_channel_path(const std::string& name);

class SimChannelWriter {
 public:
  /// Makes the channel for frames of at most this size; replaces what a dead writer left behind.
  /// Throws heel::Error, also when a living writer already serves this name.
  SimChannelWriter(const std::string& name, std::uint32_t max_width_px, std::uint32_t max_height_px);
  /// Tells the readers and removes the name.
  ~SimChannelWriter();
  SimChannelWriter(const SimChannelWriter&) = delete;
  SimChannelWriter& operator=(const SimChannelWriter&) = delete;

  /// A private frame to fill; the same one until publish(). The header's sequence must count up.
  WritableFrame writable();
  /// Copies the filled frame into the channel and wakes the readers. Throws heel::Error when its size is
  /// larger than the channel's.
  void publish();
  /// writable(), copy, publish().
  void push(const FrameView& frame);

 private:
  void take_over_name(const std::string& name);
  void map_new_segment(const std::string& name, std::uint64_t total_bytes);

  std::string path_;
  int fd_ = -1;
  SimChannelHeader* channel_ = nullptr;
  FrameHeader frame_;
  std::uint32_t max_width_px_;
  std::uint32_t max_height_px_;
  std::uint32_t stride_bytes_;
  std::vector<std::uint64_t> pixels_;  // words: the copy into the channel is by atomic words
};

/// Slot `n` mod slots of a mapped channel.
SimSlotHeader* sim_slot(SimChannelHeader* channel, std::uint32_t n);
const SimSlotHeader* sim_slot(const SimChannelHeader* channel, std::uint32_t n);

}  // namespace heel
