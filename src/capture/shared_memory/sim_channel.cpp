#include "capture/shared_memory/sim_channel.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <new>

#include "heel/error.h"
#include "realtime/clock.h"
#include "realtime/futex.h"

namespace heel {

namespace {

constexpr std::uint32_t kMaxSide_px = 16384;

std::uint32_t round_up(std::uint32_t value, std::uint32_t step) {
  return (value + step - 1) / step * step;
}

Error channel_error(const std::string& path, const std::string& what) {
  return Error(fmt::format("shared memory {}: {}: {}", path, what, std::strerror(errno)));
}

}  // namespace

std::string sim_channel_path(const std::string& name) {
  const auto allowed = [](unsigned char c) { return std::isalnum(c) || c == '-' || c == '_' || c == '.'; };
  if (name.empty() || name.size() > 64 || !std::all_of(name.begin(), name.end(), allowed)) {
    throw Error(fmt::format(
        "sim:{}: bad channel name (expected 1 to 64 letters, digits, '-', '_' or '.', e.g. sim:yard)", name));
  }
  return "/heel-sim-" + name;
}

SimSlotHeader* sim_slot(SimChannelHeader* channel, std::uint32_t n) {
  auto* first = reinterpret_cast<std::uint8_t*>(channel) + sizeof(SimChannelHeader);
  return reinterpret_cast<SimSlotHeader*>(first + channel->slot_bytes * (n % channel->slots));
}

const SimSlotHeader* sim_slot(const SimChannelHeader* channel, std::uint32_t n) {
  return sim_slot(const_cast<SimChannelHeader*>(channel), n);
}

SimChannelWriter::SimChannelWriter(const std::string& name, std::uint32_t max_width_px,
                                   std::uint32_t max_height_px)
    : path_(sim_channel_path(name)),
      max_width_px_(max_width_px),
      max_height_px_(max_height_px),
      stride_bytes_(round_up(max_width_px, kCacheLineBytes)) {
  if (max_width_px == 0 || max_height_px == 0 || max_width_px > kMaxSide_px || max_height_px > kMaxSide_px) {
    throw Error(fmt::format("sim:{}: frames of {}x{} px (expected 1 to {} px on each side)", name,
                            max_width_px, max_height_px, kMaxSide_px));
  }
  const std::uint64_t pixel_bytes = std::uint64_t{stride_bytes_} * max_height_px_;
  const std::uint64_t slot_bytes = sizeof(SimSlotHeader) + pixel_bytes;
  const std::uint64_t total_bytes = sizeof(SimChannelHeader) + kSimSlots * slot_bytes;
  pixels_.assign(pixel_bytes / kWordBytes, 0);

  remove_dead_segment(name);
  map_new_segment(name, total_bytes);
  channel_->version = kSimChannelVersion;
  channel_->slots = kSimSlots;
  channel_->max_width_px = max_width_px_;
  channel_->max_height_px = max_height_px_;
  channel_->stride_bytes = stride_bytes_;
  channel_->slot_bytes = slot_bytes;
  channel_->total_bytes = total_bytes;
  channel_->magic.store(kSimChannelMagic, std::memory_order_release);
}

// Removes the name that a dead writer has left. A reader that checks whether the writer is alive holds the
// lock for a moment, so one refusal does not mean that it is.
void SimChannelWriter::remove_dead_segment(const std::string& name) {
  const int old = shm_open(path_.c_str(), O_RDWR | O_CLOEXEC, 0);
  if (old < 0) {
    if (errno == ENOENT) return;
    throw channel_error(path_, "cannot open the existing segment");
  }
  constexpr int kTries = 10;
  bool locked = false;
  for (int i = 0; i < kTries && !locked; ++i) {
    locked = flock(old, LOCK_EX | LOCK_NB) == 0;
    if (!locked) sleep_until_ns(monotonic_now_ns() + 5 * kNsPerMs);
  }
  if (locked) shm_unlink(path_.c_str());
  ::close(old);
  if (!locked) {
    throw Error(fmt::format("sim:{}: another simulator serves this channel (expected a free name)", name));
  }
}

void SimChannelWriter::map_new_segment(const std::string& name, std::uint64_t total_bytes) {
  fd_ = shm_open(path_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
  if (fd_ < 0) {
    if (errno == EEXIST) {
      throw Error(fmt::format(
          "sim:{}: another simulator has just created this channel (expected a free name)", name));
    }
    throw channel_error(path_, "cannot create");
  }
  // Locked while it is empty, so that a reader that finds the segment finds its writer alive.
  void* memory = MAP_FAILED;
  if (flock(fd_, LOCK_EX | LOCK_NB) == 0 && ftruncate(fd_, static_cast<off_t>(total_bytes)) == 0) {
    memory = mmap(nullptr, total_bytes, PROT_READ | PROT_WRITE, MAP_SHARED, fd_, 0);
  }
  if (memory == MAP_FAILED) {
    const Error error = channel_error(path_, fmt::format("cannot allocate {} bytes", total_bytes));
    shm_unlink(path_.c_str());
    ::close(fd_);
    throw error;
  }
  // New shared memory is zero, which is a valid state of every member.
  channel_ = new (memory) SimChannelHeader{};
}

SimChannelWriter::~SimChannelWriter() {
  channel_->closed.store(1, std::memory_order_release);
  futex_wake_all(channel_->published, FutexScope::Shared);
  munmap(channel_, channel_->total_bytes);
  shm_unlink(path_.c_str());
  ::close(fd_);
}

WritableFrame SimChannelWriter::writable() {
  return {&frame_, reinterpret_cast<std::uint8_t*>(pixels_.data()), stride_bytes_};
}

void SimChannelWriter::publish() {
  if (frame_.width_px > max_width_px_ || frame_.height_px > max_height_px_) {
    throw Error(fmt::format("shared memory {}: a frame of {}x{} px (expected at most {}x{})", path_,
                            frame_.width_px, frame_.height_px, max_width_px_, max_height_px_));
  }
  const std::uint32_t n = channel_->published.load(std::memory_order_relaxed) + 1;
  SimSlotHeader* slot = sim_slot(channel_, n);
  slot->lock.store(2 * std::uint64_t{n} + 1, std::memory_order_relaxed);
  // Readers may copy the slot while it changes, and then discard the copy; therefore every word is atomic.
  // Release for each word: a reader that sees any word of the new frame also sees the odd lock.
  slot->sequence.store(frame_.sequence, std::memory_order_release);
  slot->t_capture_ns.store(frame_.t_capture_ns, std::memory_order_release);
  slot->width_px.store(frame_.width_px, std::memory_order_release);
  slot->height_px.store(frame_.height_px, std::memory_order_release);
  auto* words = reinterpret_cast<std::uint64_t*>(slot + 1);
  const std::size_t count = std::size_t{stride_bytes_} * frame_.height_px / kWordBytes;
  for (std::size_t i = 0; i < count; ++i) {
    std::atomic_ref<std::uint64_t>(words[i]).store(pixels_[i], std::memory_order_release);
  }
  slot->lock.store(2 * std::uint64_t{n}, std::memory_order_release);
  channel_->published.store(n, std::memory_order_release);
  futex_wake_all(channel_->published, FutexScope::Shared);
}

void SimChannelWriter::push(const FrameView& frame) {
  frame_ = frame.header;
  if (frame_.width_px <= max_width_px_ && frame_.height_px <= max_height_px_) {
    const WritableFrame slot = writable();
    for (std::uint32_t y = 0; y < frame_.height_px; ++y) {
      std::memcpy(slot.grey + std::size_t{y} * stride_bytes_,
                  frame.grey + std::size_t{y} * frame.stride_bytes, frame_.width_px);
    }
  }
  publish();
}

}  // namespace heel
