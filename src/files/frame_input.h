// A sequence of frames from files: images, folders of images (in natural order: 2 before 10) and videos.
// Frames are numbered from 0 across all inputs, so that a single video's numbers are its own.
#pragma once

#include <cstdint>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "heel/camera_model.h"

namespace heel {

struct InputFrame {
  std::uint64_t number = 0;
  double t_s = 0.0;  ///< in a video its own time stamp; images follow each other at the rate given
  std::string file;  ///< the image or video it came from
  cv::Mat grey;      ///< 8-bit, continuous
};

/// Throws heel::Error naming the frame's file unless it has the camera's size.
void require_size(const InputFrame& frame, const CameraModel& camera, const std::string& camera_file);

class FrameInput {
 public:
  /// Looks at every input: throws heel::Error naming the first that is no image, folder or video.
  FrameInput(const std::vector<std::string>& inputs, double image_rate_hz);
  ~FrameInput();
  FrameInput(const FrameInput&) = delete;
  FrameInput& operator=(const FrameInput&) = delete;

  /// The next frame; false after the last. Throws heel::Error naming a file that does not decode.
  bool next(InputFrame& frame);
  /// Goes over `count` frames without handing them out; false when the inputs end before.
  bool skip(std::uint64_t count);
  /// Frames in all inputs as their headers promise; 0 when one does not tell.
  std::uint64_t promised_frames() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace heel
