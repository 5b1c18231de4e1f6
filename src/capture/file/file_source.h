// Frames from files: a video (whatever OpenCV decodes), one image, or a folder of images in natural order.
//
// Pace: a video at its own rate, images at camera.rate_hz, times `file_speed`; 0: as fast as asked.
// Times:  file_speed > 0: CLOCK_MONOTONIC, each frame given at, and stamped with, its due time;
//         file_speed = 0: time in the file, the first frame at 0 (so that runs repeat to the bit).
// `sequence` is the frame's index in the file or folder, from 0. A frame is never skipped: a reader that is
// slow moves the remaining due times.
// OpenCV's decoders allocate for each frame: this source is for trials, not for the robot.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "capture/frame_source.h"

namespace heel {

class FileSource final : public FrameSource {
 public:
  FileSource(const std::string& path, double rate_hz, double file_speed);
  ~FileSource() override;

  /// Refused: nothing at the path, not readable, or a folder without images.
  OpenResult open() override;
  FrameResult wait_frame(TimeNs timeout_ns, FrameView& frame) override;
  void close() override;

  /// The pace of the file itself, frames per second of its own time; valid once opened.
  double rate_hz() const { return own_rate_hz_; }

 private:
  struct Decoder;
  OpenResult open_images();
  OpenResult open_video();
  FrameResult decode_next();
  TimeNs due_ns();

  std::string path_;
  double image_rate_hz_;
  double file_speed_;
  double own_rate_hz_ = 0.0;
  std::unique_ptr<Decoder> decoder_;
  std::vector<std::string> images_;  ///< empty: a video
  std::uint64_t next_ = 0;           ///< index of the frame to decode next
  bool decoded_ = false;             ///< frame next_ − 1 is decoded and not given yet
  // Due time of frame k: origin_ns_ + (k − origin_index_) / (rate · speed).
  TimeNs origin_ns_ = 0;
  std::uint64_t origin_index_ = 0;
  bool has_origin_ = false;
};

}  // namespace heel
