#include "telemetry/picture_recorder.h"

#include <utility>

#include "realtime/clock.h"

namespace heel {

PictureRecorder::PictureRecorder(PictureQueue* frames, const std::string& which, Encoder encoder)
    : frames_(frames),
      records_(which != "none"),
      on_fault_(which == "on_fault"),
      lossless_(which == "lossless"),
      encoder_(std::move(encoder)) {}

void PictureRecorder::drain(Recorder& recorder, TimeNs budget_ns) {
  if (!records()) {
    discard();
    return;
  }
  const TimeNs t_end_ns = monotonic_now_ns() + budget_ns;
  for (FrameView frame = frames_->front(); frame.grey != nullptr; frame = frames_->front()) {
    if (show_) show_(frame);
    RecordedPicture picture = encoder_(frame, lossless_);
    frames_->pop();
    if (on_fault_) {
      keep(std::move(picture));
    } else {
      recorder.record(picture);
    }
    if (monotonic_now_ns() >= t_end_ns) return;
  }
}

std::uint64_t PictureRecorder::discard() {
  std::uint64_t frames = 0;
  if (frames_ == nullptr) return frames;
  for (FrameView frame = frames_->front(); frame.grey != nullptr; frame = frames_->front(), ++frames) {
    if (show_) show_(frame);
    frames_->pop();
  }
  kept_.clear();
  kept_bytes_ = 0;
  return frames;
}

void PictureRecorder::keep(RecordedPicture picture) {
  const TimeNs t_oldest_ns = picture.header.t_capture_ns - kKept_ns;
  kept_bytes_ += picture.bytes.size();
  kept_.push_back(std::move(picture));
  while (kept_bytes_ > kMaxKeptBytes || kept_.front().header.t_capture_ns < t_oldest_ns) {
    kept_bytes_ -= kept_.front().bytes.size();
    kept_.pop_front();
  }
}

void PictureRecorder::write_kept(Recorder& recorder) {
  for (const RecordedPicture& picture : kept_) recorder.record(picture);
  kept_.clear();
  kept_bytes_ = 0;
}

}  // namespace heel
