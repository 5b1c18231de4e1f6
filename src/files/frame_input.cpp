// Frames from images, folders and videos (see frame_input.h).
#include "files/frame_input.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "files/image_file.h"
#include "files/natural_order.h"
#include "heel/error.h"

namespace heel {
namespace {

namespace fs = std::filesystem;

struct Source {
  std::string path;
  bool video = false;
  std::uint64_t promised_frames = 1;
};

bool is_image(const std::string& path) {
  try {
    return cv::haveImageReader(path);
  } catch (const cv::Exception&) {
    return false;
  }
}

/// Only FFmpeg: other backends would take a path for a pattern, a pipeline or a device.
bool open_video(const std::string& path, cv::VideoCapture& video) {
  try {
    return video.open(path, cv::CAP_FFMPEG);
  } catch (const cv::Exception&) {
    return false;
  }
}

Source probe_file(const std::string& path) {
  if (!std::ifstream(path)) throw Error(path + ": cannot read: " + std::strerror(errno));
  if (is_image(path)) return {path, false, 1};
  cv::VideoCapture video;
  if (!open_video(path, video))
    throw Error(path + ": not an image or video (expected one, or a folder of images)");
  const double count = video.get(cv::CAP_PROP_FRAME_COUNT);
  return {path, true, count > 0 ? static_cast<std::uint64_t>(count) : 0};
}

void add_folder(const fs::path& folder, std::vector<Source>& sources) {
  std::vector<std::string> images;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.is_regular_file() && is_image(entry.path().string())) images.push_back(entry.path().string());
  }
  if (images.empty()) throw Error(folder.string() + ": no image in this folder (expected at least one)");
  std::sort(images.begin(), images.end(), natural_less);
  for (const std::string& image : images) sources.push_back({image, false, 1});
}

}  // namespace

struct FrameInput::Impl {
  std::vector<Source> sources;
  double image_period_s = 0.0;
  std::size_t current = 0;
  cv::VideoCapture video;
  cv::Mat colour;
  std::uint64_t number = 0;  // of the next frame
  double start_s = 0.0;      // where the current source begins
  double last_s = 0.0;       // time of the last frame given

  bool grab_video(const Source& source);
  void next_source();
  double video_time_s() const { return start_s + video.get(cv::CAP_PROP_POS_MSEC) * 1e-3; }
};

bool FrameInput::Impl::grab_video(const Source& source) {
  if (!video.isOpened() && !open_video(source.path, video))
    throw Error(source.path + ": cannot be opened again");
  return video.grab();
}

void FrameInput::Impl::next_source() {
  video.release();
  ++current;
  start_s = last_s + image_period_s;
}

FrameInput::FrameInput(const std::vector<std::string>& inputs, double image_rate_hz)
    : impl_(std::make_unique<Impl>()) {
  for (const std::string& input : inputs) {
    if (fs::is_directory(input)) {
      add_folder(input, impl_->sources);
    } else {
      impl_->sources.push_back(probe_file(input));
    }
  }
  impl_->image_period_s = 1.0 / image_rate_hz;
}

FrameInput::~FrameInput() = default;

bool FrameInput::next(InputFrame& frame) {
  Impl& in = *impl_;
  while (in.current < in.sources.size()) {
    const Source& source = in.sources[in.current];
    frame.file = source.path;
    if (!source.video) {
      frame.grey = read_grey_image(source.path);
      frame.t_s = in.last_s = in.start_s;
      frame.number = in.number++;
      in.next_source();
      return true;
    }
    if (in.grab_video(source) && in.video.retrieve(in.colour)) {
      if (in.colour.channels() == 3) {
        cv::cvtColor(in.colour, frame.grey, cv::COLOR_BGR2GRAY);
      } else {
        in.colour.copyTo(frame.grey);
      }
      frame.t_s = in.last_s = in.video_time_s();
      frame.number = in.number++;
      return true;
    }
    in.next_source();
  }
  return false;
}

bool FrameInput::skip(std::uint64_t count) {
  Impl& in = *impl_;
  while (count > 0 && in.current < in.sources.size()) {
    const Source& source = in.sources[in.current];
    if (!source.video) {
      in.last_s = in.start_s;
    } else if (in.grab_video(source)) {
      in.last_s = in.video_time_s();
    } else {
      in.next_source();
      continue;
    }
    ++in.number;
    --count;
    if (!source.video) in.next_source();
  }
  return count == 0;
}

std::uint64_t FrameInput::promised_frames() const {
  std::uint64_t frames = 0;
  for (const Source& source : impl_->sources) {
    if (source.promised_frames == 0) return 0;
    frames += source.promised_frames;
  }
  return frames;
}

void require_size(const InputFrame& frame, const CameraModel& camera, const std::string& camera_file) {
  if (frame.grey.cols == camera.width_px && frame.grey.rows == camera.height_px) return;
  throw Error(frame.file + ": " + std::to_string(frame.grey.cols) + "x" + std::to_string(frame.grey.rows) +
              " pixels (expected " + std::to_string(camera.width_px) + "x" +
              std::to_string(camera.height_px) + " as in " + camera_file + ")");
}

}  // namespace heel
