#include "sim/render/jpeg_round_trip.h"

#include <csetjmp>
#include <cstdio>
#include <cstdlib>
#include <string>
// libjpeg's header needs <cstdio> before it.
#include <jpeglib.h>

#include "heel/error.h"

namespace heel::sim {
namespace {

/// libjpeg reports an error through a function that must not return.
struct Failure {
  jpeg_error_mgr manager{};
  std::jmp_buf return_point{};
  char message[JMSG_LENGTH_MAX] = {};
};

[[noreturn]] void fail(j_common_ptr codec) {
  auto* failure = reinterpret_cast<Failure*>(codec->err);
  codec->err->format_message(codec, failure->message);
  std::longjmp(failure->return_point, 1);
}

struct Compressed {
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
};

// compress() and decompress() have no objects with destructors: longjmp leaves them from inside libjpeg.
bool compress(const std::vector<std::uint8_t>& grey, int width_px, int height_px, int quality,
              Failure& failure, Compressed& out) {
  jpeg_compress_struct codec{};
  codec.err = jpeg_std_error(&failure.manager);
  failure.manager.error_exit = fail;
  if (setjmp(failure.return_point) != 0) {
    jpeg_destroy_compress(&codec);
    return false;
  }
  jpeg_create_compress(&codec);
  jpeg_mem_dest(&codec, &out.bytes, &out.size);
  codec.image_width = static_cast<JDIMENSION>(width_px);
  codec.image_height = static_cast<JDIMENSION>(height_px);
  codec.input_components = 1;
  codec.in_color_space = JCS_GRAYSCALE;
  jpeg_set_defaults(&codec);
  jpeg_set_quality(&codec, quality, TRUE);
  codec.dct_method = JDCT_ISLOW;  // the same on every machine
  jpeg_start_compress(&codec, TRUE);
  while (codec.next_scanline < codec.image_height) {
    // libjpeg takes a mutable pointer, but only reads through it.
    JSAMPROW row = const_cast<std::uint8_t*>(grey.data()) +
                   static_cast<std::size_t>(codec.next_scanline) * static_cast<std::size_t>(width_px);
    jpeg_write_scanlines(&codec, &row, 1);
  }
  jpeg_finish_compress(&codec);
  jpeg_destroy_compress(&codec);
  return true;
}

bool decompress(const Compressed& in, std::vector<std::uint8_t>& grey, int width_px, Failure& failure) {
  jpeg_decompress_struct codec{};
  codec.err = jpeg_std_error(&failure.manager);
  failure.manager.error_exit = fail;
  if (setjmp(failure.return_point) != 0) {
    jpeg_destroy_decompress(&codec);
    return false;
  }
  jpeg_create_decompress(&codec);
  jpeg_mem_src(&codec, in.bytes, in.size);
  jpeg_read_header(&codec, TRUE);
  codec.dct_method = JDCT_ISLOW;
  jpeg_start_decompress(&codec);
  while (codec.output_scanline < codec.output_height) {
    JSAMPROW row =
        grey.data() + static_cast<std::size_t>(codec.output_scanline) * static_cast<std::size_t>(width_px);
    jpeg_read_scanlines(&codec, &row, 1);
  }
  jpeg_finish_decompress(&codec);
  jpeg_destroy_decompress(&codec);
  return true;
}

}  // namespace

void jpeg_round_trip(std::vector<std::uint8_t>& grey, int width_px, int height_px, int quality) {
  Failure failure;
  Compressed compressed;
  const bool done = compress(grey, width_px, height_px, quality, failure, compressed) &&
                    decompress(compressed, grey, width_px, failure);
  std::free(compressed.bytes);
  if (!done) throw Error(std::string("simulated Motion-JPEG: ") + failure.message);
}

}  // namespace heel::sim
