// Which pictures go into a recording: all, or those of the last seconds before a fault or a mark.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>

#include "realtime/picture_queue.h"
#include "recording/picture.h"
#include "telemetry/recorder.h"

namespace heel {

class PictureRecorder {
 public:
  static constexpr TimeNs kKept_ns = 30 * kNsPerS;
  static constexpr std::size_t kMaxKeptBytes = 48 << 20;

  /// `frames` is borrowed; null: there are none. `which` is a value of telemetry.pictures.
  PictureRecorder(PictureQueue* frames, const std::string& which);

  /// Takes all waiting frames. To be called often: the queue holds a second or two.
  void drain(Recorder& recorder);
  /// Writes those that are kept in memory.
  void write_kept(Recorder& recorder);

  std::uint64_t lost() const { return frames_ == nullptr ? 0 : frames_->dropped(); }

 private:
  void keep(RecordedPicture picture);

  PictureQueue* const frames_;
  const bool on_fault_, lossless_;
  std::deque<RecordedPicture> kept_;
  std::size_t kept_bytes_ = 0;
};

}  // namespace heel
