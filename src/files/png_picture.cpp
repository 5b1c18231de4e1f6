#include "files/png_picture.h"

#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <cstring>
#include <utility>
#include <vector>

namespace heel {
namespace {

// Of red and green; blue has the rest. The weights of JPEG and of OpenCV.
constexpr double kRed = 0.299, kGreen = 0.587;
constexpr std::size_t kMaxPngPixels = std::size_t{1} << 27;

/// What libpng's callbacks and the code after a jump need.
struct PngReading {
  ByteView file;
  std::size_t at = 0;
  PngPicture picture;
  std::vector<png_bytep> rows;
  bool all_rows = false;
};

void read_bytes(png_structp png, png_bytep out, std::size_t count) {
  auto& reading = *static_cast<PngReading*>(png_get_io_ptr(png));
  if (count > reading.file.size() - reading.at) {
    reading.picture.has_end = false;
    png_error(png, "ends too early");
  }
  std::memcpy(out, reading.file.data() + reading.at, count);
  reading.at += count;
}

[[noreturn]] void keep_error(png_structp png, png_const_charp text) {
  static_cast<PngReading*>(png_get_error_ptr(png))->picture.problem = text;
  png_longjmp(png, 1);
}

void ignore_warning(png_structp, png_const_charp) {}

/// One channel, 8 or 16 bits.
void set_transformations(png_structp png, png_infop info) {
  const int colour = png_get_color_type(png, info);
  png_set_strip_alpha(png);
  if (colour == PNG_COLOR_TYPE_PALETTE) png_set_palette_to_rgb(png);
  if (colour == PNG_COLOR_TYPE_GRAY && png_get_bit_depth(png, info) < 8) png_set_expand_gray_1_2_4_to_8(png);
  if ((colour & PNG_COLOR_MASK_COLOR) != 0) png_set_rgb_to_gray(png, 1, kRed, kGreen);
  png_set_swap(png);  // a PNG's 16-bit numbers are big-endian
  png_set_interlace_handling(png);
  png_read_update_info(png, info);
}

int stated_bits(png_structp png, png_infop info) {
  png_color_8p bits = nullptr;
  if (png_get_sBIT(png, info, &bits) == 0) return 0;
  const bool coloured = (png_get_color_type(png, info) & PNG_COLOR_MASK_COLOR) != 0;
  return coloured ? std::max({bits->red, bits->green, bits->blue}) : bits->gray;
}

/// All of it between setjmp and longjmp, so that it has no object with a destructor.
void read_all(png_structp png, png_infop info, PngReading& reading) {
  PngPicture& picture = reading.picture;
  png_read_info(png, info);
  picture.width_px = png_get_image_width(png, info);
  picture.height_px = png_get_image_height(png, info);
  if (std::size_t{picture.width_px} * picture.height_px > kMaxPngPixels) png_error(png, "too large");
  picture.deep = png_get_bit_depth(png, info) == 16;
  picture.significant_bits = stated_bits(png, info);
  set_transformations(png, info);
  const std::size_t row_bytes = std::size_t{picture.width_px} * (picture.deep ? 2 : 1);
  if (png_get_rowbytes(png, info) != row_bytes) png_error(png, "unknown kind of pixels");
  picture.bytes.resize(row_bytes * picture.height_px);
  reading.rows.resize(picture.height_px);
  for (std::size_t y = 0; y < picture.height_px; ++y) reading.rows[y] = picture.bytes.data() + y * row_bytes;
  png_read_image(png, reading.rows.data());
  reading.all_rows = true;
  png_read_end(png, nullptr);
}

}  // namespace

PngPicture decode_png(ByteView file) {
  PngReading reading{file, 0, {}, {}};
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &reading, keep_error, ignore_warning);
  png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
  if (info != nullptr) {
    png_set_read_fn(png, &reading, read_bytes);
    if (setjmp(png_jmpbuf(png)) == 0) {
      read_all(png, info, reading);
    } else if (!reading.all_rows || reading.picture.has_end) {
      reading.picture.bytes.clear();
    }
  }
  png_destroy_read_struct(&png, &info, nullptr);
  return std::move(reading.picture);
}

}  // namespace heel
