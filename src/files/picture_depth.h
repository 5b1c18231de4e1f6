// Pictures of 10, 12, 14 or 16 bits to 8, by the bits that their values really have.
#pragma once

#include <opencv2/core/mat.hpp>
#include <string>

namespace heel {

struct EightBitPicture {
  cv::Mat grey;      ///< CV_8U
  int white = 0;     ///< the value that became 255
  std::string note;  ///< what was taken for white, where the file's kind of pixels does not say it
};

/// `raw`: CV_8U or CV_16U. `stated_white`: the largest value that the file says its pixels can have; 0 when
/// it says none. Without it, or where pixels are above it, white is the largest value of the fewest bits of
/// 8, 10, 12, 14 and 16 that hold the picture, but not less than `least_white`: that of a picture of the same
/// sequence.
EightBitPicture to_8_bit(const cv::Mat& raw, int stated_white, int least_white = 0);

}  // namespace heel
