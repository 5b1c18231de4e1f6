// The pictures in which a calibration board is sought: photographs, folders of them, and frames of videos.
#pragma once

#include <string>
#include <vector>

namespace heel::cli {

/// Of a video the sharpest frame of each of kFramesOfVideo parts is taken, since the frames between are as it
/// or blurred. They are files in a folder that is removed with this object.
class BoardImages {
 public:
  static constexpr std::size_t kFramesOfVideo = 40;

  /// Throws heel::Error naming an input that is no image, folder of images or video.
  explicit BoardImages(const std::vector<std::string>& inputs);
  ~BoardImages();
  BoardImages(const BoardImages&) = delete;
  BoardImages& operator=(const BoardImages&) = delete;

  const std::vector<std::string>& files() const { return files_; }
  /// One line for each video of which a part is missing.
  const std::vector<std::string>& problems() const { return problems_; }
  /// About the inputs, one line each: FrameInput::notes().
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  void add_folder(const std::string& folder);
  void add_video(const std::string& video);
  std::string new_folder_for(const std::string& video);

  std::string folder_;  ///< of the frames; empty: none yet
  std::vector<std::string> files_, problems_, notes_;
};

}  // namespace heel::cli
