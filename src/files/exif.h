// What a picture's file says of the picture: its orientation (EXIF) and, of TIFF, how deep its pixels are.
#pragma once

#include <cstddef>

#include "files/byte_view.h"

namespace heel {

struct TiffTags {
  int orientation = 1;             ///< as in EXIF, 1 to 8
  std::size_t orientation_at = 0;  ///< its place in the bytes; 0: not stated
  std::size_t orientation_bytes = 0;
  int max_sample_value = 0;  ///< 0: not stated
  int bits = 0;              ///< of a sample of the first kind; 0: not stated
  bool has_floats = false;   ///< its samples are floating-point numbers
};

/// The tags of the first directory of a TIFF file or an EXIF block, which is one. Damaged bytes: what could
/// be read before them.
TiffTags read_tiff_tags(ByteView tiff);

/// The orientation that a JPEG, PNG, WebP or TIFF file states; 1 when it states none.
int orientation_in_file(ByteView file);

}  // namespace heel
