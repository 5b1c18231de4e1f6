#include "files/jpeg_decoder.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstdio>
// libjpeg's headers need <cstdio> before them.
#include <jerror.h>
#include <jpeglib.h>

#include <vector>

namespace heel {

namespace {

// libjpeg reports a fatal error through error_exit, which must not return: it jumps back to decode().
struct ErrorManager {
  jpeg_error_mgr base{};  // must be first: libjpeg passes a pointer to it
  std::jmp_buf back{};
  std::array<char, JMSG_LENGTH_MAX> message{};
  bool end_missing = false;
  bool bytes_left_over = false;
  // The first warning, from which a message is made only of a damaged image: cameras may cause harmless ones
  // with every frame.
  int first_code = 0;
  decltype(jpeg_error_mgr::msg_parm) first_values{};
};

void keep_message(j_common_ptr jpeg) {
  auto* manager = reinterpret_cast<ErrorManager*>(jpeg->err);
  jpeg->err->format_message(jpeg, manager->message.data());
}

[[noreturn]] void jump_back(j_common_ptr jpeg) {
  keep_message(jpeg);
  std::longjmp(reinterpret_cast<ErrorManager*>(jpeg->err)->back, 1);
}

/// Cameras leave 1 to 8 bytes before a marker. Where a damaged image has lost its place, more are left over,
/// or too few, which is another warning.
constexpr int kMaxHarmlessBytes = 16;

void count_warning(j_common_ptr jpeg, int level) {
  if (level >= 0) return;
  auto* manager = reinterpret_cast<ErrorManager*>(jpeg->err);
  if (manager->first_code == 0) {
    manager->first_code = jpeg->err->msg_code;
    manager->first_values = jpeg->err->msg_parm;
  }
  switch (jpeg->err->msg_code) {
    case JWRN_JPEG_EOF:
      manager->end_missing = true;
      return;
    case JWRN_EXTRANEOUS_DATA:
      manager->bytes_left_over = true;
      if (jpeg->err->msg_parm.i[0] <= kMaxHarmlessBytes) return;
      break;
    default:
      break;
  }
  ++jpeg->err->num_warnings;
}

void print_nothing(j_common_ptr) {}

/// Of an image whose rows are all decoded: whether every scan was there. The library warns of bits that are
/// missing in a scan, but not of whole scans, nor of the end of arithmetic codes.
bool has_all_scans(const jpeg_decompress_struct& jpeg) {
  if (jpeg.arith_code != FALSE) return false;
  for (int i = 0; i < jpeg.num_components; ++i) {
    if (jpeg.comp_info[i].quant_table == nullptr) return false;  // kept when the first scan of it begins
    if (jpeg.progressive_mode == FALSE) continue;
    const int* const missing_bits = jpeg.coef_bits[i];
    if (std::any_of(missing_bits, missing_bits + DCTSIZE2, [](int bits) { return bits != 0; })) return false;
  }
  return true;
}

}  // namespace

struct JpegDecoder::Impl {
  jpeg_decompress_struct jpeg{};
  ErrorManager errors;
  std::vector<std::uint8_t> cmyk_row;
  bool all_scans = false;  // of the last image

  bool has_end() const { return !errors.end_missing; }
  void read_rows(std::uint8_t* grey);
};

// libjpeg does not convert CMYK, as image editors write it (inverted), to grey.
void JpegDecoder::Impl::read_rows(std::uint8_t* grey) {
  const std::size_t width_px = jpeg.output_width;
  while (jpeg.output_scanline < jpeg.output_height) {
    std::uint8_t* const out = grey + jpeg.output_scanline * width_px;
    JSAMPROW row = jpeg.out_color_space == JCS_CMYK ? cmyk_row.data() : out;
    jpeg_read_scanlines(&jpeg, &row, 1);
    if (row == out) continue;
    for (std::size_t x = 0; x < width_px; ++x) {
      const std::uint8_t* const p = row + 4 * x;
      out[x] = static_cast<std::uint8_t>((299 * p[0] + 587 * p[1] + 114 * p[2]) / 1000 * p[3] / 255);
    }
  }
}

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

bool JpegDecoder::has_end() const {
  return impl_->has_end();
}

// These functions must not hold an object with a destructor, because longjmp skips destructors.
bool JpegDecoder::read_size(const std::uint8_t* jpeg, std::size_t bytes, std::uint32_t& width_px,
                            std::uint32_t& height_px) {
  Impl& d = *impl_;
  d.errors.message[0] = '\0';
  if (setjmp(d.errors.back) != 0) {
    jpeg_abort_decompress(&d.jpeg);
    return false;
  }
  jpeg_mem_src(&d.jpeg, jpeg, static_cast<unsigned long>(bytes));
  jpeg_read_header(&d.jpeg, TRUE);
  width_px = d.jpeg.image_width;
  height_px = d.jpeg.image_height;
  jpeg_abort_decompress(&d.jpeg);
  return true;
}

bool JpegDecoder::decode(const std::uint8_t* jpeg, std::size_t bytes, std::uint32_t width_px,
                         std::uint32_t height_px, std::uint8_t* grey) {
  Impl& d = *impl_;
  d.errors.base.num_warnings = 0;
  d.errors.message[0] = '\0';
  d.errors.end_missing = d.errors.bytes_left_over = false;
  d.errors.first_code = 0;
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
  const bool cmyk = d.jpeg.num_components == 4;
  d.jpeg.out_color_space = cmyk ? JCS_CMYK : JCS_GRAYSCALE;
  if (cmyk) d.cmyk_row.resize(std::size_t{width_px} * 4);
  jpeg_start_decompress(&d.jpeg);
  d.read_rows(grey);
  d.all_scans = has_all_scans(d.jpeg);
  jpeg_finish_decompress(&d.jpeg);
  // Where bytes are left over, the end of the image may have been read out of what is none, as of zeros.
  const bool has_all = d.has_end() || (d.all_scans && !d.errors.bytes_left_over);
  if (has_all && d.errors.base.num_warnings == 0) return true;
  d.errors.base.msg_code = d.errors.first_code;
  d.errors.base.msg_parm = d.errors.first_values;
  keep_message(reinterpret_cast<j_common_ptr>(&d.jpeg));
  return false;
}

}  // namespace heel
