// Frames from files for commands that work through recorded pictures: images, folders of images (in natural
// order: 2 before 10) and videos, one after the other. Frames are numbered from 0 across all inputs.
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
  double t_s = 0.0;  ///< of a video's frame: its own time stamp; of images: by the rate given
  std::string file;  ///< the image or video it came from
  cv::Mat grey;      ///< 8-bit, one block of memory
};

/// Throws heel::Error naming the frame's file unless it has the camera's size.
void require_size(const InputFrame& frame, const CameraModel& camera, const std::string& camera_file);

/// As images_in_folder, for commands: throws heel::Error naming the folder unless there is an image. `notes`
/// gets a line about videos that are passed over.
std::vector<std::string> images_of_folder(const std::string& folder, std::vector<std::string>& notes);

class FrameInput {
 public:
  /// Checks every input. Throws heel::Error naming the first that is no image, folder of images or video.
  FrameInput(const std::vector<std::string>& inputs, double image_rate_hz);
  ~FrameInput();
  FrameInput(const FrameInput&) = delete;
  FrameInput& operator=(const FrameInput&) = delete;

  /// The next frame; false after the last. Throws heel::Error naming a file that does not decode.
  bool next(InputFrame& frame);
  /// Passes over `count` frames; false when the inputs have fewer.
  bool skip(std::uint64_t count);
  /// Frames read and passed over so far.
  std::uint64_t frames_passed() const;
  /// Frames in all inputs as the files' headers state them; 0 when one does not.
  std::uint64_t stated_frame_count() const;
  /// Of the inputs passed so far: what was taken for the depth of their pixels, one line each time it
  /// changes, and for interlaced videos; of folders the videos that are passed over.
  const std::vector<std::string>& notes() const;
  /// Of the inputs passed so far: those of which a part is missing, "walk.mkv: ends after 20 of 40 frames".
  const std::vector<std::string>& problems() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace heel
