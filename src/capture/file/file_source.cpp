#include "capture/file/file_source.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <system_error>

#include "files/natural_order.h"
#include "realtime/clock.h"

namespace heel {

namespace fs = std::filesystem;

struct FileSource::Decoder {
  cv::VideoCapture video;
  cv::Mat colour;
  cv::Mat grey;
};

namespace {

bool is_image_name(const fs::path& path) {
  static constexpr std::array<const char*, 9> kExtensions{".png", ".jpg", ".jpeg", ".bmp", ".pgm",
                                                          ".ppm", ".pnm", ".tif",  ".tiff"};
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::find(kExtensions.begin(), kExtensions.end(), extension) != kExtensions.end();
}

std::string hertz(double rate_hz) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.4g Hz", rate_hz);
  return text.data();
}

}  // namespace

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
    return fail(OpenResult::Refused, "no such file; expected a video, an image or a folder of images");
  }
  decoder_ = std::make_unique<Decoder>();
  const OpenResult result = fs::is_directory(status) || is_image_name(path_) ? open_images() : open_video();
  if (result != OpenResult::Opened) close();
  return result;
}

OpenResult FileSource::open_images() {
  if (fs::is_directory(path_)) {
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator(path_, error)) {
      if (is_image_name(entry.path())) images_.push_back(entry.path().string());
    }
    if (error) return fail(OpenResult::Refused, "cannot list the folder: " + error.message());
    if (images_.empty()) {
      return fail(OpenResult::Refused, "the folder holds no images; expected .png, .jpg, .bmp, .pgm or .tif");
    }
    std::sort(images_.begin(), images_.end(), natural_less);
  } else {
    images_.push_back(path_);
  }
  own_rate_hz_ = image_rate_hz_;
  description_ = address_ + ": " + std::to_string(images_.size()) + " image(s) at " + hertz(own_rate_hz_);
  return OpenResult::Opened;
}

OpenResult FileSource::open_video() {
  cv::VideoCapture& video = decoder_->video;
  if (!video.open(path_, cv::CAP_FFMPEG)) {
    return fail(OpenResult::Refused, "cannot be decoded; expected a video, an image or a folder of images");
  }
  const double rate_hz = video.get(cv::CAP_PROP_FPS);
  own_rate_hz_ = std::isfinite(rate_hz) && rate_hz > 0.0 ? rate_hz : image_rate_hz_;
  description_ = address_ + ": video, " + std::to_string(std::lround(video.get(cv::CAP_PROP_FRAME_WIDTH))) +
                 "x" + std::to_string(std::lround(video.get(cv::CAP_PROP_FRAME_HEIGHT))) + " at " +
                 hertz(own_rate_hz_);
  return OpenResult::Opened;
}

FrameResult FileSource::wait_frame(TimeNs timeout_ns, FrameView& frame) {
  if (decoder_ == nullptr) return fail(FrameResult::Lost, "not open");
  const TimeNs asked_ns = monotonic_now_ns();
  if (!decoded_) {
    const FrameResult result = decode_next();
    if (result != FrameResult::Frame) return result;
  }
  const TimeNs t_capture_ns = due_ns();
  if (file_speed_ > 0.0) {
    sleep_until_ns(std::min(t_capture_ns, asked_ns + timeout_ns));
    if (monotonic_now_ns() < t_capture_ns) return FrameResult::Timeout;
  }
  decoded_ = false;
  const cv::Mat& grey = decoder_->grey;
  frame.header = {.sequence = next_ - 1,
                  .t_capture_ns = t_capture_ns,
                  .width_px = static_cast<std::uint32_t>(grey.cols),
                  .height_px = static_cast<std::uint32_t>(grey.rows)};
  frame.grey = grey.data;
  frame.stride_bytes = static_cast<std::uint32_t>(grey.step);
  return FrameResult::Frame;
}

FrameResult FileSource::decode_next() {
  Decoder& decoder = *decoder_;
  if (images_.empty()) {
    if (!decoder.video.read(decoder.colour)) {
      return fail(FrameResult::EndOfStream, "ended after " + std::to_string(next_) + " frames");
    }
    cv::cvtColor(decoder.colour, decoder.grey, cv::COLOR_BGR2GRAY);
  } else {
    if (next_ == images_.size()) {
      return fail(FrameResult::EndOfStream, "ended after " + std::to_string(next_) + " images");
    }
    decoder.grey = cv::imread(images_[next_], cv::IMREAD_GRAYSCALE);
  }
  ++next_;
  if (decoder.grey.empty()) {
    ++counters_.corrupt;
    return fail(FrameResult::Error, images_[next_ - 1] + " cannot be decoded; expected an image");
  }
  decoded_ = true;
  return FrameResult::Frame;
}

TimeNs FileSource::due_ns() {
  const std::uint64_t index = next_ - 1;
  if (file_speed_ <= 0.0) return ns_from_seconds(static_cast<double>(index) / own_rate_hz_);
  const double period_s = 1.0 / (own_rate_hz_ * file_speed_);
  const TimeNs now_ns = monotonic_now_ns();
  if (has_origin_) {
    const TimeNs due = origin_ns_ + ns_from_seconds(static_cast<double>(index - origin_index_) * period_s);
    // More than a period behind: the reader (or the decoder) is slow. Go on from here, so that the stamps
    // stay what a camera's would be and no burst follows.
    if (now_ns - due <= ns_from_seconds(period_s)) return due;
  }
  has_origin_ = true;
  origin_ns_ = now_ns;
  origin_index_ = index;
  return now_ns;
}

void FileSource::close() {
  decoder_.reset();
  images_.clear();
  next_ = 0;
  decoded_ = false;
  has_origin_ = false;
}

}  // namespace heel
