// PNG files to grey, by libpng.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <span>
#include <string>

#include "files/byte_view.h"

namespace heel {

/// The picture as stored, grey: CV_8U, or CV_16U with the values of the file. Empty: damaged or cut short;
/// `problem` says how. `significant_bits`: of the values, by the file's sBIT chunk; 0 when it has none.
cv::Mat decode_png(ByteView file, int& significant_bits, std::string& problem);

}  // namespace heel
