#include "capture/shared_memory/sim_source.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "realtime/clock.h"
#include "realtime/futex.h"

namespace heel {

namespace {

constexpr const char* kEnded = "the simulator that served this channel has ended";

/// Copies a slot under its sequence lock. False: the writer changed it meanwhile.
bool copy_slot(const SimChannelHeader& channel, std::uint32_t n, FrameHeader& header,
               std::vector<std::uint64_t>& pixels) {
  const SimSlotHeader* slot = sim_slot(&channel, n);
  const std::uint64_t whole = 2 * std::uint64_t{n};
  if (slot->lock.load(std::memory_order_acquire) != whole) return false;
  // Acquire for each word: after reading a word that the writer stored later, the second read of the lock
  // below sees a changed value.
  header.sequence = slot->sequence.load(std::memory_order_acquire);
  header.t_capture_ns = slot->t_capture_ns.load(std::memory_order_acquire);
  header.width_px = slot->width_px.load(std::memory_order_acquire);
  header.height_px = slot->height_px.load(std::memory_order_acquire);
  const std::size_t rows = std::min(header.height_px, channel.max_height_px);
  const std::size_t count = rows * channel.stride_bytes / kWordBytes;
  auto* words = const_cast<std::uint64_t*>(reinterpret_cast<const std::uint64_t*>(slot + 1));
  for (std::size_t i = 0; i < count; ++i) {
    pixels[i] = std::atomic_ref<std::uint64_t>(words[i]).load(std::memory_order_acquire);
  }
  return slot->lock.load(std::memory_order_relaxed) == whole;
}

}  // namespace

SimSource::SimSource(const std::string& name) : FrameSource("sim:" + name), path_(sim_channel_path(name)) {}

SimSource::~SimSource() {
  close();
}

OpenResult SimSource::open() {
  close();
  OpenResult result = map_segment();
  if (result == OpenResult::Opened) result = check_header();
  if (result != OpenResult::Opened) {
    close();
    return result;
  }
  pixels_.assign(std::size_t{channel_->stride_bytes} * channel_->max_height_px / kWordBytes, 0);
  last_published_ = channel_->published.load(std::memory_order_acquire);  // frames before this are old
  has_sequence_ = false;
  description_ = fmt::format("{}: up to {}x{} px from shared memory {}", address_, channel_->max_width_px,
                             channel_->max_height_px, path_);
  return result;
}

OpenResult SimSource::map_segment() {
  fd_ = shm_open(path_.c_str(), O_RDONLY | O_CLOEXEC, 0);
  if (fd_ < 0) {
    if (errno == ENOENT) return fail(OpenResult::Absent, "no simulator serves this channel");
    return fail(OpenResult::Refused, fmt::format("shared memory {}: {}", path_, std::strerror(errno)));
  }
  struct stat file {};
  if (fstat(fd_, &file) != 0 || file.st_size < static_cast<off_t>(sizeof(SimChannelHeader))) {
    return fail(OpenResult::Absent, "the simulator is starting");
  }
  if (!writer_is_alive()) return fail(OpenResult::Absent, kEnded);
  const auto bytes = static_cast<std::uint64_t>(file.st_size);
  void* memory = mmap(nullptr, bytes, PROT_READ, MAP_SHARED, fd_, 0);
  if (memory == MAP_FAILED) {
    return fail(OpenResult::Refused,
                fmt::format("shared memory {}: cannot map {} bytes: {}", path_, bytes, std::strerror(errno)));
  }
  channel_ = static_cast<const SimChannelHeader*>(memory);
  mapped_bytes_ = bytes;
  return OpenResult::Opened;
}

OpenResult SimSource::check_header() {
  const std::uint32_t magic = channel_->magic.load(std::memory_order_acquire);
  if (magic == 0) return fail(OpenResult::Absent, "the simulator is starting");
  if (magic != kSimChannelMagic) {
    return fail(OpenResult::Refused, fmt::format("shared memory {}: not a frame channel", path_));
  }
  if (channel_->version != kSimChannelVersion) {
    return fail(OpenResult::Refused, fmt::format("shared memory {}: version {} (expected {})", path_,
                                                 channel_->version, kSimChannelVersion));
  }
  const SimChannelHeader& c = *channel_;
  const bool consistent =
      c.slots >= 2 && c.slots <= 64 && c.max_width_px > 0 && c.max_height_px > 0 &&
      c.stride_bytes >= c.max_width_px && c.stride_bytes % kWordBytes == 0 &&
      c.slot_bytes >= sizeof(SimSlotHeader) + std::uint64_t{c.stride_bytes} * c.max_height_px &&
      c.slot_bytes % kWordBytes == 0 && c.slot_bytes <= mapped_bytes_ &&
      sizeof(SimChannelHeader) + c.slots * c.slot_bytes <= mapped_bytes_;
  if (!consistent) {
    return fail(OpenResult::Refused, fmt::format("shared memory {}: its header contradicts its size", path_));
  }
  // A writer that has closed the channel holds its name and lock until its process ends.
  if (c.closed.load(std::memory_order_acquire) != 0) return fail(OpenResult::Absent, kEnded);
  return OpenResult::Opened;
}

// The writer holds the exclusive lock while it is alive, so a shared lock is granted only when it is dead.
bool SimSource::writer_is_alive() const {
  if (flock(fd_, LOCK_SH | LOCK_NB) != 0) return true;
  flock(fd_, LOCK_UN);
  return false;
}

FrameResult SimSource::wait_frame(TimeNs timeout_ns, FrameView& frame) {
  if (channel_ == nullptr) return fail(FrameResult::Lost, "is not open");
  const TimeNs until_ns = monotonic_now_ns() + timeout_ns;
  while (true) {
    const std::uint32_t published = channel_->published.load(std::memory_order_acquire);
    if (published != last_published_) {
      if (copy_slot(*channel_, published, header_, pixels_)) {
        last_published_ = published;
        return deliver(frame);
      }
      // The writer has overwritten the slot, so there is a newer frame. A correct writer always keeps the
      // newest one complete; the bound is for others.
      if (monotonic_now_ns() > until_ns) return FrameResult::Timeout;
      continue;
    }
    if (channel_->closed.load(std::memory_order_acquire) != 0) {
      return fail(FrameResult::Lost, "the simulator has ended");
    }
    const TimeNs left_ns = until_ns - monotonic_now_ns();
    if (left_ns <= 0) break;
    futex_wait(channel_->published, published, left_ns, FutexScope::Shared);
  }
  if (!writer_is_alive()) return fail(FrameResult::Lost, "the simulator has been killed");
  return FrameResult::Timeout;
}

FrameResult SimSource::deliver(FrameView& frame) {
  if (header_.width_px > channel_->max_width_px || header_.height_px > channel_->max_height_px) {
    ++counters_.corrupt;
    return fail(FrameResult::Error, "the frame is larger than its channel");
  }
  if (has_sequence_ && header_.sequence > frame_sequence_ + 1) {
    counters_.dropped_by_driver += header_.sequence - frame_sequence_ - 1;
  }
  has_sequence_ = true;
  frame_sequence_ = header_.sequence;
  frame = {header_, reinterpret_cast<const std::uint8_t*>(pixels_.data()), channel_->stride_bytes};
  return FrameResult::Frame;
}

void SimSource::close() {
  if (channel_ != nullptr) munmap(const_cast<SimChannelHeader*>(channel_), mapped_bytes_);
  if (fd_ >= 0) ::close(fd_);
  channel_ = nullptr;
  fd_ = -1;
}

}  // namespace heel
