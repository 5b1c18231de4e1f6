// A video file as grey pictures, one after the other, as they are shown (display matrix) and with the time
// stamps that the file states.
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

  /// False when FFmpeg's libraries cannot decode the file; problem() says why.
  bool open(const std::string& path);
  bool is_open() const;
  void close();
  /// Why open() failed, without the file's name.
  const std::string& problem() const;

  /// The next frame, 8-bit grey; false at the end. Damaged frames are left out.
  bool read(cv::Mat& grey);
  /// What is taken for the pixels, when the header or a frame so far gives reason to: "interlaced: every
  /// second row is used"; else empty.
  std::string note() const;
  /// Passes over the next frame; false at the end.
  bool skip();
  /// At the end: what is missing of the video, as "ends after 20 of 40 frames"; empty when nothing is.
  std::string missing() const;

  /// Of the last frame read or skipped, from the first frame; each is later than the one before.
  double time_s() const;
  /// As the file's header states them; 0 when it does not.
  double rate_hz() const;
  std::uint64_t frame_count() const;
  /// As shown.
  cv::Size size_px() const;

 private:
  struct Decoder;
  std::unique_ptr<Decoder> decoder_;
};

}  // namespace heel
