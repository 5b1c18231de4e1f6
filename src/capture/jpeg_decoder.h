// JPEG images, as Motion-JPEG cameras send them, to 8-bit grey. By libjpeg-turbo, which decodes only the luma
// then; it takes and gives back its working memory with every image, from the heap.
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

  /// Decodes into `grey`, densely packed. False: corrupt, truncated, or not of exactly this size; `grey` may
  /// then hold part of the image, and problem() says what is wrong.
  bool decode(const std::uint8_t* jpeg, std::size_t bytes, std::uint32_t width_px, std::uint32_t height_px,
              std::uint8_t* grey);
  const char* problem() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace heel
