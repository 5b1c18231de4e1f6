#include "operator/web/picture_encoder.h"

#include <jpeglib.h>

#include <csetjmp>
#include <cstdio>  // jpeglib.h needs it before itself
#include <cstdlib>

namespace heel {
namespace {

struct EncoderError {
  jpeg_error_mgr manager;  // the first member: libjpeg knows its address only
  std::jmp_buf back;
};

[[noreturn]] void give_up(j_common_ptr info) {
  std::longjmp(reinterpret_cast<EncoderError*>(info->err)->back, 1);
}
void say_nothing(j_common_ptr) {}

/// Holds no object with a destructor: libjpeg leaves it by a jump. False: `bytes` may still have to be freed.
bool compress(const KeptFrame& frame, int quality, unsigned char** bytes, unsigned long* count) {
  jpeg_compress_struct info{};
  EncoderError error{};
  info.err = jpeg_std_error(&error.manager);
  error.manager.error_exit = give_up;
  error.manager.output_message = say_nothing;
  if (setjmp(error.back) != 0) {
    jpeg_destroy_compress(&info);
    return false;
  }
  jpeg_create_compress(&info);
  jpeg_mem_dest(&info, bytes, count);
  info.image_width = frame.header.width_px;
  info.image_height = frame.header.height_px;
  info.input_components = 1;
  info.in_color_space = JCS_GRAYSCALE;
  jpeg_set_defaults(&info);
  jpeg_set_quality(&info, quality, TRUE);
  info.dct_method = JDCT_ISLOW;
  jpeg_start_compress(&info, TRUE);
  while (info.next_scanline < info.image_height) {
    JSAMPROW row =
        const_cast<JSAMPROW>(frame.grey.data()) + std::size_t{info.next_scanline} * info.image_width;
    jpeg_write_scanlines(&info, &row, 1);
  }
  jpeg_finish_compress(&info);
  jpeg_destroy_compress(&info);
  return true;
}

}  // namespace

std::string jpeg_of(const KeptFrame& frame, int quality) {
  const std::size_t pixels = std::size_t{frame.header.width_px} * frame.header.height_px;
  if (pixels == 0 || frame.grey.size() != pixels) return "";
  unsigned char* bytes = nullptr;
  unsigned long count = 0;
  std::string jpeg;
  if (compress(frame, quality, &bytes, &count)) jpeg.assign(reinterpret_cast<const char*>(bytes), count);
  std::free(bytes);
  return jpeg;
}

}  // namespace heel
