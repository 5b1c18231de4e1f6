#include "files/frame_input.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <utility>

#include "files/atomic_file.h"
#include "files/image_file.h"
#include "files/video_reader.h"
#include "heel/error.h"

namespace heel {
namespace {

/// One image or one video.
struct InputFile {
  std::string path;
  bool is_video = false;
  std::uint64_t stated_frame_count = 1;
};

InputFile checked_file(const std::string& path) {
  require_regular_file(path);
  if (!std::ifstream(path)) throw Error(path + ": cannot read: " + std::strerror(errno));
  if (is_image_file(path)) return {path};
  VideoReader video;
  if (!video.open(path))
    throw Error(fmt::format("{}: not an image or video: {} (expected one, or a folder of images)", path,
                            video.problem()));
  return {path, true, video.frame_count()};
}

}  // namespace

std::vector<std::string> images_of_folder(const std::string& folder, std::vector<std::string>& notes) {
  std::error_code error;
  const FolderImages found = images_in_folder(folder, error);
  if (error) throw Error(folder + ": cannot read the folder: " + error.message());
  const std::string videos = found.passed_over();
  if (found.images.empty())
    throw Error(folder + ": no image in this folder (expected at least one)" +
                (videos.empty() ? "" : "; " + videos));
  if (!videos.empty()) notes.push_back(folder + ": " + videos);
  return found.images;
}

struct FrameInput::Impl {
  std::vector<InputFile> files;
  double image_period_s = 0.0;
  std::size_t current = 0;   // index of the file that the next frame comes from
  VideoReader video;         // the current file, when it is a video
  std::uint64_t number = 0;  // of the next frame
  double t_begin_s = 0.0;    // of the current file's first frame
  double t_last_s = 0.0;     // of the last frame
  int white = 0;             // of the deepest image so far
  bool video_noted = false;  // the current one
  bool missing_noted = false;
  std::vector<std::string> notes;
  std::vector<std::string> problems;

  /// The current file's reader, opened at its first frame.
  VideoReader& current_video();
  cv::Mat read_image(const std::string& path);
  void note_video();
  void end_video();
  void go_to_next_file();
  double video_time_s() const { return t_begin_s + video.time_s(); }
};

VideoReader& FrameInput::Impl::current_video() {
  if (!video.is_open() && !video.open(files[current].path))
    throw Error(files[current].path + ": cannot be opened a second time");
  return video;
}

cv::Mat FrameInput::Impl::read_image(const std::string& path) {
  const GreyImage image = read_grey_image(path, white);
  if (!image.note.empty() && image.white != white) {
    notes.push_back(path + ": " + image.note);
    white = image.white;
  }
  // Once, because a camera that leaves the ends out does so in every picture.
  if (!image.missing.empty() && !std::exchange(missing_noted, true))
    notes.push_back(path + ": " + image.missing);
  return image.grey;
}

void FrameInput::Impl::note_video() {
  if (video_noted || video.note().empty()) return;
  video_noted = true;
  notes.push_back(files[current].path + ": " + video.note());
}

void FrameInput::Impl::end_video() {
  if (const std::string missing = video.missing(); !missing.empty())
    problems.push_back(files[current].path + ": " + missing);
  go_to_next_file();
}

void FrameInput::Impl::go_to_next_file() {
  video.close();
  video_noted = false;
  ++current;
  t_begin_s = t_last_s + image_period_s;
}

FrameInput::FrameInput(const std::vector<std::string>& inputs, double image_rate_hz)
    : impl_(std::make_unique<Impl>()) {
  for (const std::string& input : inputs) {
    if (std::filesystem::is_directory(input)) {
      for (const std::string& image : images_of_folder(input, impl_->notes)) impl_->files.push_back({image});
    } else {
      impl_->files.push_back(checked_file(input));
    }
  }
  impl_->image_period_s = 1.0 / image_rate_hz;
}

FrameInput::~FrameInput() = default;

bool FrameInput::next(InputFrame& frame) {
  Impl& in = *impl_;
  while (in.current < in.files.size()) {
    const InputFile& file = in.files[in.current];
    frame.file = file.path;
    if (!file.is_video) {
      frame.grey = in.read_image(file.path);
      frame.t_s = in.t_last_s = in.t_begin_s;
      frame.number = in.number++;
      in.go_to_next_file();
      return true;
    }
    if (in.current_video().read(frame.grey)) {
      in.note_video();
      frame.t_s = in.t_last_s = in.video_time_s();
      frame.number = in.number++;
      return true;
    }
    in.end_video();
  }
  return false;
}

bool FrameInput::skip(std::uint64_t count) {
  Impl& in = *impl_;
  while (count > 0 && in.current < in.files.size()) {
    const bool is_video = in.files[in.current].is_video;
    if (is_video && !in.current_video().skip()) {
      in.end_video();
      continue;
    }
    in.t_last_s = is_video ? in.video_time_s() : in.t_begin_s;
    ++in.number;
    --count;
    if (!is_video) in.go_to_next_file();
  }
  return count == 0;
}

std::uint64_t FrameInput::frames_passed() const {
  return impl_->number;
}

std::uint64_t FrameInput::stated_frame_count() const {
  std::uint64_t frames = 0;
  for (const InputFile& file : impl_->files) {
    if (file.stated_frame_count == 0) return 0;
    frames += file.stated_frame_count;
  }
  return frames;
}

const std::vector<std::string>& FrameInput::notes() const {
  return impl_->notes;
}

const std::vector<std::string>& FrameInput::problems() const {
  return impl_->problems;
}

void require_size(const InputFrame& frame, const CameraModel& camera, const std::string& camera_file) {
  if (frame.grey.cols == camera.width_px && frame.grey.rows == camera.height_px) return;
  const bool turned = frame.grey.cols == camera.height_px && frame.grey.rows == camera.width_px;
  throw Error(
      fmt::format("{}: {}x{} pixels (expected {}x{} as in {}{})", frame.file, frame.grey.cols,
                  frame.grey.rows, camera.width_px, camera.height_px, camera_file,
                  turned ? "; pictures and videos are turned as they are shown: calibrate with such" : ""));
}

}  // namespace heel
