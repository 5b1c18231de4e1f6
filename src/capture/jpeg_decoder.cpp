#include "capture/jpeg_decoder.h"

#include <fmt/format.h>

#include <array>
#include <csetjmp>
#include <cstdio>
// libjpeg's header needs <cstdio> before it.
#include <jpeglib.h>

namespace heel {

namespace {

// libjpeg reports a fatal error through error_exit, which must not return: it jumps back to decode().
struct ErrorManager {
  jpeg_error_mgr base{};  // must be first: libjpeg passes a pointer to it
  std::jmp_buf back{};
  std::array<char, JMSG_LENGTH_MAX> message{};
};

void keep_message(j_common_ptr jpeg) {
  auto* manager = reinterpret_cast<ErrorManager*>(jpeg->err);
  jpeg->err->format_message(jpeg, manager->message.data());
}

[[noreturn]] void jump_back(j_common_ptr jpeg) {
  keep_message(jpeg);
  std::longjmp(reinterpret_cast<ErrorManager*>(jpeg->err)->back, 1);
}

// A warning ("premature end of JPEG file") means a damaged image. libjpeg would fill the rest with grey.
void count_warning(j_common_ptr jpeg, int level) {
  if (level >= 0) return;
  if (jpeg->err->num_warnings++ == 0) keep_message(jpeg);
}

void print_nothing(j_common_ptr) {}

}  // namespace

struct JpegDecoder::Impl {
  jpeg_decompress_struct jpeg{};
  ErrorManager errors;
};

JpegDecoder::JpegDecoder() : impl_(std::make_unique<Impl>()) {
  Impl& d = *impl_;
  d.jpeg.err = jpeg_std_error(&d.errors.base);
  d.errors.base.error_exit = jump_back;
  d.errors.base.emit_message = count_warning;
  d.errors.base.output_message = print_nothing;
  jpeg_create_decompress(&d.jpeg);
}

JpegDecoder::~JpegDecoder() {
  jpeg_destroy_decompress(&impl_->jpeg);
}

const char* JpegDecoder::problem() const {
  return impl_->errors.message.data();
}

// This function must not hold an object with a destructor, because longjmp skips destructors.
bool JpegDecoder::decode(const std::uint8_t* jpeg, std::size_t bytes, std::uint32_t width_px,
                         std::uint32_t height_px, std::uint8_t* grey) {
  Impl& d = *impl_;
  d.errors.base.num_warnings = 0;
  d.errors.message[0] = '\0';
  if (setjmp(d.errors.back) != 0) {
    jpeg_abort_decompress(&d.jpeg);
    return false;
  }
  jpeg_mem_src(&d.jpeg, jpeg, static_cast<unsigned long>(bytes));
  jpeg_read_header(&d.jpeg, TRUE);
  if (d.jpeg.image_width != width_px || d.jpeg.image_height != height_px) {
    *fmt::format_to_n(d.errors.message.data(), d.errors.message.size() - 1,
                      "a JPEG of {}x{} px (expected {}x{})", d.jpeg.image_width, d.jpeg.image_height,
                      width_px, height_px)
         .out = '\0';
    jpeg_abort_decompress(&d.jpeg);
    return false;
  }
  d.jpeg.out_color_space = JCS_GRAYSCALE;
  jpeg_start_decompress(&d.jpeg);
  while (d.jpeg.output_scanline < height_px) {
    JSAMPROW row = grey + std::size_t{d.jpeg.output_scanline} * width_px;
    jpeg_read_scanlines(&d.jpeg, &row, 1);
  }
  jpeg_finish_decompress(&d.jpeg);
  return d.errors.base.num_warnings == 0;
}

}  // namespace heel
