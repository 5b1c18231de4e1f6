// Decodes JPEG images, as files have them and as Motion-JPEG cameras send them, to 8-bit grey, by
// libjpeg-turbo. Only the luma is decoded. The library allocates its working memory for each image and frees
// it again.
//
// A few bytes too many before a marker, which the encoders of many cameras leave there, do no harm and are
// passed over. So is a missing end marker, as some cameras and interrupted downloads leave it, when nothing
// else is missing. Every other warning of the library means a damaged image, whose rest it would fill with
// grey.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

namespace heel {

class JpegDecoder {
 public:
  JpegDecoder();
  ~JpegDecoder();
  JpegDecoder(const JpegDecoder&) = delete;
  JpegDecoder& operator=(const JpegDecoder&) = delete;

  /// Reads the size of an image. False: this is no JPEG image that can be decoded to grey; problem() says
  /// why.
  bool read_size(const std::uint8_t* jpeg, std::size_t bytes, std::uint32_t& width_px,
                 std::uint32_t& height_px);
  /// Decodes to `grey`, densely packed. False: the image is corrupt, truncated, or of another size; problem()
  /// says which, and `grey` may hold a part of the image.
  bool decode(const std::uint8_t* jpeg, std::size_t bytes, std::uint32_t width_px, std::uint32_t height_px,
              std::uint8_t* grey);
  const char* problem() const;
  /// Whether the last decoded image had its end marker.
  bool has_end() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace heel
