// Portable grey and colour maps (PGM, PPM) whose largest value is not 255: OpenCV takes 4095 of 12 bits for a
// dark picture of 16.
#pragma once

#include <cstdint>
#include <span>

#include "files/byte_view.h"

namespace heel {

/// The largest value that a PGM or PPM file states; 0 when it is no such file, or states none.
int largest_value_of_pnm(ByteView file);

}  // namespace heel
