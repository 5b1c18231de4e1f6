// Frames between processes: the simulator's camera writes them to POSIX shared memory "/heel-sim-NAME"; the
// daemon's SimSource, or any other program, maps it read-only and reads the newest.
//
//   SimChannelWriter writer("yard", 640, 480);      // e.g. in heel-sim
//   WritableFrame slot = writer.writable();         // fill *slot.header and slot.grey, then
//   writer.publish();
//
// Layout: one SimChannelHeader, then kSimSlots slots of `slot_bytes` each: a SimSlotHeader and the pixels.
// Frame number n (from 1) is written to slot n mod kSimSlots under the sequence lock of that slot, which is
// odd during the writing and 2n after it. Readers copy a slot and keep the copy only if the lock has not
// changed meanwhile.
//
// The writer holds flock(LOCK_EX) on its segment, so a reader can tell whether the writer is alive. Each
// writer creates a new segment.
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
inline constexpr std::uint32_t kWordBytes = 8;  ///< pixels are stored and loaded in atomic words of this size

struct SimChannelHeader {
  std::atomic<std::uint32_t> magic;  ///< written last, when the segment is ready
  std::uint32_t version;
  std::uint32_t slots;
  std::uint32_t max_width_px;
  std::uint32_t max_height_px;
  std::uint32_t stride_bytes;
  std::uint64_t slot_bytes;
  std::uint64_t total_bytes;
  std::atomic<std::uint32_t> published;  ///< number of the newest frame; readers wait on it as a futex
  std::atomic<std::uint32_t> closed;     ///< 1: the writer has ended in order
  std::uint8_t reserved[16];
};
static_assert(sizeof(SimChannelHeader) == 64);

struct SimSlotHeader {
  std::atomic<std::uint64_t> lock;  ///< odd: being written; 2n: holds frame n
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
  /// Creates the channel for frames of at most this size, and replaces one whose writer is dead. Throws
  /// heel::Error, also when another writer serves this name.
  SimChannelWriter(const std::string& name, std::uint32_t max_width_px, std::uint32_t max_height_px);
  /// Marks the channel as closed, wakes the readers and removes the name.
  ~SimChannelWriter();
  SimChannelWriter(const SimChannelWriter&) = delete;
  SimChannelWriter& operator=(const SimChannelWriter&) = delete;

  /// A private frame to fill; it stays the same until publish(). The sequence of its header must count up.
  WritableFrame writable();
  /// Copies the filled frame to the channel and wakes the readers. Throws heel::Error when the frame is
  /// larger than the channel's.
  void publish();
  /// writable(), copy, publish().
  void push(const FrameView& frame);

 private:
  void remove_dead_segment(const std::string& name);
  void map_new_segment(const std::string& name, std::uint64_t total_bytes);

  std::string path_;
  int fd_ = -1;
  SimChannelHeader* channel_ = nullptr;
  FrameHeader frame_;
  std::uint32_t max_width_px_;
  std::uint32_t max_height_px_;
  std::uint32_t stride_bytes_;
  std::vector<std::uint64_t> pixels_;  // in words, as they are copied to the channel
};

/// Slot `n` mod slots of a mapped channel.
SimSlotHeader* sim_slot(SimChannelHeader* channel, std::uint32_t n);
const SimSlotHeader* sim_slot(const SimChannelHeader* channel, std::uint32_t n);

}  // namespace heel
