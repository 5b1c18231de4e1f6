#include "capture/file/file_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "files/image_file.h"
#include "files/video_reader.h"
#include "realtime/clock.h"

namespace heel {

namespace fs = std::filesystem;

struct FileSource::Decoder {
  VideoReader video;
  cv::Mat grey;
  int white = 0;  // of the deepest image so far
};

FileSource::FileSource(const std::string& path, double rate_hz, double file_speed)
    : FrameSource("file:" + path),
      path_(path),
      image_rate_hz_(rate_hz > 0.0 ? rate_hz : 1.0),
      file_speed_(file_speed) {}

FileSource::~FileSource() = default;

OpenResult FileSource::open() {
  close();
  std::error_code error;
  const fs::file_status status = fs::status(path_, error);
  if (!fs::exists(status)) {
    return fail(OpenResult::Refused, "no such file (expected a video, an image or a folder of images)");
  }
  decoder_ = std::make_unique<Decoder>();
  const OpenResult result = fs::is_directory(status) || is_image_file(path_) ? open_images() : open_video();
  if (result != OpenResult::Opened) close();
  return result;
}

OpenResult FileSource::open_images() {
  std::string videos;
  if (fs::is_directory(path_)) {
    std::error_code error;
    FolderImages found = images_in_folder(path_, error);
    if (error) return fail(OpenResult::Refused, "cannot read the folder: " + error.message());
    videos = found.passed_over();
    if (found.images.empty()) {
      return fail(OpenResult::Refused,
                  "the folder holds no images (expected .png, .jpg, .bmp, .pgm or .tif)" +
                      (videos.empty() ? "" : "; " + videos));
    }
    images_ = std::move(found.images);
  } else {
    images_.push_back(path_);
  }
  own_rate_hz_ = image_rate_hz_;
  description_ = fmt::format("{}: {} image(s) at {:.4g} Hz", address_, images_.size(), own_rate_hz_);
  if (!videos.empty()) description_ += ", " + videos;
  const GreyImage first = decode_grey_image(images_.front());
  for (const std::string& said : {first.note, first.missing})
    if (!said.empty()) description_ += ", " + said;
  return OpenResult::Opened;
}

OpenResult FileSource::open_video() {
  VideoReader& video = decoder_->video;
  if (!video.open(path_)) {
    return fail(OpenResult::Refused,
                fmt::format("cannot be decoded: {} (expected a video, an image or a folder of images)",
                            video.problem()));
  }
  own_rate_hz_ = video.rate_hz() > 0.0 ? video.rate_hz() : image_rate_hz_;
  const cv::Size size_px = video.size_px();
  description_ =
      fmt::format("{}: video, {}x{} px at {:.4g} Hz", address_, size_px.width, size_px.height, own_rate_hz_);
  if (!video.note().empty()) description_ += ", " + video.note();
  return OpenResult::Opened;
}

FrameResult FileSource::wait_frame(TimeNs timeout_ns, FrameView& frame) {
  if (decoder_ == nullptr) return fail(FrameResult::Lost, "is not open");
  const TimeNs t_call_ns = monotonic_now_ns();
  if (!decoded_) {
    const FrameResult result = decode_next();
    if (result == FrameResult::EndOfStream && !wait_for_end_of_last_frame(t_call_ns + timeout_ns))
      return FrameResult::Timeout;
    if (result != FrameResult::Frame) return result;
  }
  const TimeNs t_capture_ns = due_ns();
  if (file_speed_ > 0.0) {
    sleep_until_ns(std::min(t_capture_ns, t_call_ns + timeout_ns));
    if (monotonic_now_ns() < t_capture_ns) return FrameResult::Timeout;
  }
  decoded_ = false;
  t_last_ns_ = t_capture_ns;
  const cv::Mat& grey = decoder_->grey;
  frame.header = {.sequence = next_ - 1,
                  .t_capture_ns = t_capture_ns,
                  .width_px = static_cast<std::uint32_t>(grey.cols),
                  .height_px = static_cast<std::uint32_t>(grey.rows)};
  frame.grey = grey.data;
  frame.stride_bytes = static_cast<std::uint32_t>(grey.step);
  return FrameResult::Frame;
}

/// The last frame lasts as long as any other, so that a file that starts again keeps its pace.
bool FileSource::wait_for_end_of_last_frame(TimeNs until_ns) const {
  if (file_speed_ <= 0.0 || next_ == 0) return true;
  const TimeNs end_ns = t_last_ns_ + ns_from_seconds(1.0 / (own_rate_hz_ * file_speed_));
  sleep_until_ns(std::min(end_ns, until_ns));
  return monotonic_now_ns() >= end_ns;
}

FrameResult FileSource::decode_next() {
  Decoder& decoder = *decoder_;
  if (images_.empty()) {
    if (!decoder.video.read(decoder.grey)) {
      const std::string missing = decoder.video.missing();
      return fail(FrameResult::EndOfStream,
                  missing.empty() ? fmt::format("ended after {} frames", next_) : missing);
    }
    period_s_ = decoder.video.time_s() - t_file_s_;
    t_file_s_ = decoder.video.time_s();
  } else {
    if (next_ == images_.size()) {
      return fail(FrameResult::EndOfStream, fmt::format("ended after {} images", next_));
    }
    GreyImage image = decode_grey_image(images_[next_], decoder.white);
    decoder.grey = image.grey;
    period_s_ = 1.0 / own_rate_hz_;
    t_file_s_ = static_cast<double>(next_) / own_rate_hz_;
    if (decoder.grey.empty()) {
      ++counters_.corrupt;
      return fail(FrameResult::Error, images_[next_++] + " cannot be decoded: " + image.problem);
    }
    if (!image.note.empty()) decoder.white = image.white;
  }
  ++next_;
  decoded_ = true;
  return FrameResult::Frame;
}

TimeNs FileSource::due_ns() {
  if (file_speed_ <= 0.0) return ns_from_seconds(t_file_s_);
  const TimeNs now_ns = monotonic_now_ns();
  if (has_origin_) {
    const TimeNs due = origin_ns_ + ns_from_seconds((t_file_s_ - t_origin_s_) / file_speed_);
    // More than a period behind: the reader or the decoder is slow. The due times start again from now, so
    // that the stamps are those of a camera and no burst follows.
    if (now_ns - due <= ns_from_seconds(period_s_ / file_speed_)) return due;
  }
  has_origin_ = true;
  origin_ns_ = now_ns;
  t_origin_s_ = t_file_s_;
  return now_ns;
}

void FileSource::close() {
  decoder_.reset();
  images_.clear();
  next_ = 0;
  decoded_ = false;
  has_origin_ = false;
  t_file_s_ = 0.0;
}

}  // namespace heel
