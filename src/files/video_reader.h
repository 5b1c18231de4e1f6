// A video file as grey pictures, one after the other.
#pragma once

#include <cstdint>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>

namespace heel {

class VideoReader {
 public:
  VideoReader();
  ~VideoReader();
  VideoReader(const VideoReader&) = delete;
  VideoReader& operator=(const VideoReader&) = delete;

  /// False when FFmpeg cannot decode the file.
  bool open(const std::string& path);
  bool is_open() const;
  void close();

  /// The next frame, 8-bit grey; false at the end.
  bool read(cv::Mat& grey);
  /// Passes over the next frame; false at the end.
  bool skip();

  /// Of the last frame read or skipped, as the file states it.
  double time_s() const;
  /// As the file's header states them; 0 when it does not.
  double rate_hz() const;
  std::uint64_t frame_count() const;
  cv::Size size_px() const;

 private:
  struct Decoder;
  std::unique_ptr<Decoder> decoder_;
};

}  // namespace heel
