#include "files/video_reader.h"

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

namespace heel {

struct VideoReader::Decoder {
  cv::VideoCapture video;
  cv::Mat decoded;

  double positive(int property) const {
    const double value = video.get(property);
    return std::isfinite(value) && value > 0.0 ? value : 0.0;
  }
};

VideoReader::VideoReader() : decoder_(std::make_unique<Decoder>()) {}
VideoReader::~VideoReader() = default;

bool VideoReader::open(const std::string& path) {
  try {
    // FFmpeg alone: OpenCV's other backends would take a path for a pattern, a pipeline or a device.
    return decoder_->video.open(path, cv::CAP_FFMPEG);
  } catch (const cv::Exception&) {
    return false;
  }
}

bool VideoReader::is_open() const {
  return decoder_->video.isOpened();
}

void VideoReader::close() {
  decoder_->video.release();
}

bool VideoReader::read(cv::Mat& grey) {
  cv::Mat& decoded = decoder_->decoded;
  if (!decoder_->video.read(decoded)) return false;
  if (decoded.channels() == 3) {
    cv::cvtColor(decoded, grey, cv::COLOR_BGR2GRAY);
  } else {
    decoded.copyTo(grey);
  }
  return true;
}

bool VideoReader::skip() {
  return decoder_->video.grab();
}

double VideoReader::time_s() const {
  return decoder_->video.get(cv::CAP_PROP_POS_MSEC) * 1e-3;
}

double VideoReader::rate_hz() const {
  return decoder_->positive(cv::CAP_PROP_FPS);
}

std::uint64_t VideoReader::frame_count() const {
  return static_cast<std::uint64_t>(decoder_->positive(cv::CAP_PROP_FRAME_COUNT));
}

cv::Size VideoReader::size_px() const {
  return {static_cast<int>(std::lround(decoder_->positive(cv::CAP_PROP_FRAME_WIDTH))),
          static_cast<int>(std::lround(decoder_->positive(cv::CAP_PROP_FRAME_HEIGHT)))};
}

}  // namespace heel
