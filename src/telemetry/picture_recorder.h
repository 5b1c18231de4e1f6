// Which pictures go into a recording: all, or those of the last seconds before a fault or a mark.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <string>

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

  /// `frames` is borrowed; null: there are none. `which` is a value of telemetry.pictures.
  PictureRecorder(PictureQueue* frames, const std::string& which, Encoder encoder = compressed_picture);

  /// Takes waiting frames until there are none, or so much time has passed. To be called often: the queue
  /// holds a second or two.
  void drain(Recorder& recorder, TimeNs budget_ns = kDrain_ns);
  /// Forgets the frames that wait, and those that are kept; the number of the former.
  std::uint64_t discard();
  /// Writes those that are kept in memory.
  void write_kept(Recorder& recorder);

  std::uint64_t lost() const { return frames_ == nullptr ? 0 : frames_->dropped(); }

 private:
  void keep(RecordedPicture picture);

  PictureQueue* const frames_;
  const bool on_fault_, lossless_;
  const Encoder encoder_;
  std::deque<RecordedPicture> kept_;
  std::size_t kept_bytes_ = 0;
};

}  // namespace heel
