// Decodes JPEG images, as Motion-JPEG cameras send them, to 8-bit grey, by libjpeg-turbo. Only the luma is
// decoded. The library allocates its working memory for each image and frees it again.
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

  /// Decodes to `grey`, densely packed. False: the image is corrupt, truncated, or of another size; problem()
  /// says which, and `grey` may hold a part of the image.
  bool decode(const std::uint8_t* jpeg, std::size_t bytes, std::uint32_t width_px, std::uint32_t height_px,
              std::uint8_t* grey);
  const char* problem() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace heel
