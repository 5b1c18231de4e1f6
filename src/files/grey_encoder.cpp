#include "files/grey_encoder.h"

#include <png.h>

#include <array>
#include <csetjmp>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
// libjpeg's header needs <cstdio> before it.
#include <jpeglib.h>

#include "heel/error.h"

namespace heel {
namespace {

constexpr int kPngEffort = 1;  // of 9: more takes three times as long for a tenth less

struct PngWriting {
  std::string file;
  std::string problem;
};

void add_bytes(png_structp png, png_bytep bytes, std::size_t count) {
  static_cast<PngWriting*>(png_get_io_ptr(png))->file.append(reinterpret_cast<const char*>(bytes), count);
}

void flush_nothing(png_structp) {}

[[noreturn]] void keep_png_error(png_structp png, png_const_charp text) {
  static_cast<PngWriting*>(png_get_error_ptr(png))->problem = text;
  png_longjmp(png, 1);
}

void ignore_png_warning(png_structp, png_const_charp) {}

/// All of it between setjmp and longjmp, so that it has no object with a destructor.
void write_png(png_structp png, png_infop info, const FrameView& grey) {
  png_set_compression_level(png, kPngEffort);
  png_set_IHDR(png, info, grey.header.width_px, grey.header.height_px, 8, PNG_COLOR_TYPE_GRAY,
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  for (std::uint32_t y = 0; y < grey.header.height_px; ++y)
    png_write_row(png, grey.grey + std::size_t{y} * grey.stride_bytes);
  png_write_end(png, info);
}

/// libjpeg reports an error through a function that must not return.
struct JpegFailure {
  jpeg_error_mgr manager{};  // must be first: libjpeg passes a pointer to it
  std::jmp_buf back{};
  std::array<char, JMSG_LENGTH_MAX> message{};
};

[[noreturn]] void keep_jpeg_error(j_common_ptr codec) {
  auto* failure = reinterpret_cast<JpegFailure*>(codec->err);
  codec->err->format_message(codec, failure->message.data());
  std::longjmp(failure->back, 1);
}

struct JpegFile {
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
};

/// Has no object with a destructor: longjmp leaves it from inside libjpeg.
bool write_jpeg(const FrameView& grey, int quality, JpegFailure& failure, JpegFile& out) {
  jpeg_compress_struct codec{};
  codec.err = jpeg_std_error(&failure.manager);
  failure.manager.error_exit = keep_jpeg_error;
  if (setjmp(failure.back) != 0) {
    jpeg_destroy_compress(&codec);
    return false;
  }
  jpeg_create_compress(&codec);
  jpeg_mem_dest(&codec, &out.bytes, &out.size);
  codec.image_width = grey.header.width_px;
  codec.image_height = grey.header.height_px;
  codec.input_components = 1;
  codec.in_color_space = JCS_GRAYSCALE;
  jpeg_set_defaults(&codec);
  jpeg_set_quality(&codec, quality, TRUE);
  codec.dct_method = JDCT_ISLOW;  // the same on every machine
  jpeg_start_compress(&codec, TRUE);
  while (codec.next_scanline < codec.image_height) {
    // libjpeg takes a mutable pointer, but only reads through it.
    JSAMPROW row =
        const_cast<std::uint8_t*>(grey.grey) + std::size_t{codec.next_scanline} * grey.stride_bytes;
    jpeg_write_scanlines(&codec, &row, 1);
  }
  jpeg_finish_compress(&codec);
  jpeg_destroy_compress(&codec);
  return true;
}

}  // namespace

std::string png_of_grey(const FrameView& grey) {
  PngWriting writing;
  png_structp png =
      png_create_write_struct(PNG_LIBPNG_VER_STRING, &writing, keep_png_error, ignore_png_warning);
  png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
  if (info != nullptr) {
    png_set_write_fn(png, &writing, add_bytes, flush_nothing);
    if (setjmp(png_jmpbuf(png)) == 0) write_png(png, info, grey);
  } else {
    writing.problem = "no memory";
  }
  png_destroy_write_struct(&png, &info);
  if (!writing.problem.empty()) throw Error("a picture cannot be made a PNG: " + writing.problem);
  return std::move(writing.file);
}

std::string jpeg_of_grey(const FrameView& grey, int quality) {
  JpegFailure failure;
  JpegFile file;
  const bool written = write_jpeg(grey, quality, failure, file);
  std::string bytes;
  if (written) bytes.assign(reinterpret_cast<const char*>(file.bytes), file.size);
  std::free(file.bytes);
  if (!written) throw Error(std::string("a picture cannot be made a JPEG: ") + failure.message.data());
  return bytes;
}

}  // namespace heel
