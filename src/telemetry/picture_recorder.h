// Which pictures go into a recording: all, or those of the last seconds before a fault or a mark.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <string>
#include <utility>

#include "realtime/picture_queue.h"
#include "recording/picture.h"
#include "telemetry/recorder.h"

namespace heel {

class PictureRecorder {
 public:
  static constexpr TimeNs kKept_ns = 30 * kNsPerS;
  static constexpr std::size_t kMaxKeptBytes = 48 << 20;

  /// For one drain: the thread that calls it has records to take as well.
  static constexpr TimeNs kDrain_ns = 20 * kNsPerMs;
  /// Makes a picture of a frame; the second argument: lossless.
  using Encoder = std::function<RecordedPicture(const FrameView&, bool)>;

  /// Sees every frame that is taken from the queue.
  using Show = std::function<void(const FrameView&)>;

  /// `frames` is borrowed; null: there are none. `which` is a value of telemetry.pictures; with none, frames
  /// are only shown.
  PictureRecorder(PictureQueue* frames, const std::string& which, Encoder encoder = compressed_picture);

  void show_to(Show show) { show_ = std::move(show); }
  /// Frames are recorded, not only shown.
  bool records() const { return frames_ != nullptr && records_; }
  /// While nobody wants frames, none are queued.
  void set_wanted(bool wanted) {
    if (frames_ != nullptr) frames_->set_open(wanted);
  }

  /// Takes waiting frames until there are none, or so much time has passed. To be called often: the queue
  /// holds a second or two.
  void drain(Recorder& recorder, TimeNs budget_ns = kDrain_ns);
  /// Forgets the frames that wait, and those that are kept; the number of the former. They are shown.
  std::uint64_t discard();
  /// Writes those that are kept in memory.
  void write_kept(Recorder& recorder);

  std::uint64_t lost() const { return records() ? frames_->dropped() : 0; }

 private:
  void keep(RecordedPicture picture);

  PictureQueue* const frames_;
  const bool records_, on_fault_, lossless_;
  const Encoder encoder_;
  Show show_;
  std::deque<RecordedPicture> kept_;
  std::size_t kept_bytes_ = 0;
};

}  // namespace heel
