// Frames from files: a video, one image, or a folder of images in natural order.
//
// Pace: a video's own time stamps, or camera.rate_hz for images, made faster by `file_speed`. With
// `file_speed` 0 each frame is given as soon as it is requested. Times: with `file_speed` > 0 those of
// CLOCK_MONOTONIC: each frame is given at its due time and stamped with it. With `file_speed` 0 the time in
// the file, from 0, so that runs repeat to the bit. Sequence: the frame's index in the file or folder, from
// 0. No frame is skipped: a slow reader delays the due times of the frames that follow.
//
// The decoders allocate memory for each frame: this source is for experiments, not for use on the robot.
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

  /// Refused: no such file, it cannot be decoded, or the folder has no images.
  OpenResult open() override;
  FrameResult wait_frame(TimeNs timeout_ns, FrameView& frame) override;
  void close() override;

  /// The mean frame rate of the file itself; valid once opened.
  double rate_hz() const { return own_rate_hz_; }

 private:
  struct Decoder;
  OpenResult open_images();
  OpenResult open_video();
  FrameResult decode_next();
  TimeNs due_ns();
  bool wait_for_end_of_last_frame(TimeNs until_ns) const;

  std::string path_;
  double image_rate_hz_;
  double file_speed_;
  double own_rate_hz_ = 0.0;
  std::unique_ptr<Decoder> decoder_;
  std::vector<std::string> images_;  ///< empty for a video
  std::uint64_t next_ = 0;           ///< index of the frame to decode next
  bool decoded_ = false;             ///< frame next_ − 1 has been decoded and not yet given
  double t_file_s_ = 0.0;            ///< of frame next_ − 1, in the file
  double period_s_ = 0.0;            ///< in the file, since the frame before it
  // Due time of a frame: origin_ns_ + (t_file_s_ − t_origin_s_) / speed.
  TimeNs origin_ns_ = 0;
  double t_origin_s_ = 0.0;
  bool has_origin_ = false;
  TimeNs t_last_ns_ = 0;  ///< due time of the last frame given
};

}  // namespace heel
