#include "files/picture_depth.h"

#include <fmt/format.h>

#include <algorithm>
#include <opencv2/core.hpp>

namespace heel {
namespace {

constexpr int kWhite8 = 255, kWhite16 = 65535;

/// The largest value of the fewest bits that hold `largest`.
int white_that_holds(int largest) {
  for (const int bits : {8, 10, 12, 14}) {
    if (largest < 1 << bits) return (1 << bits) - 1;
  }
  return kWhite16;
}

int bits_of(int white) {
  int bits = 0;
  for (; white > 0; white >>= 1) ++bits;
  return bits;
}

}  // namespace

EightBitPicture to_8_bit(const cv::Mat& raw, int stated_white, int least_white) {
  const int file_white = raw.depth() == CV_16U ? kWhite16 : kWhite8;
  if (raw.depth() == CV_8U && (stated_white == 0 || stated_white == kWhite8)) return {raw, kWhite8, ""};
  double least = 0.0, largest = 0.0;
  cv::minMaxLoc(raw, &least, &largest);
  EightBitPicture picture;
  int& white = picture.white;
  white = stated_white;
  if (stated_white == 0 || largest > stated_white) {
    white = raw.depth() == CV_16U ? std::max(white_that_holds(static_cast<int>(largest)), least_white)
                                  : file_white;
  }
  if (white != file_white) {
    picture.note = fmt::format("{} bits a pixel, of which {} are used (largest value {:.0f}); white is {}",
                               raw.depth() == CV_16U ? 16 : 8, bits_of(white), largest, white);
  }
  raw.convertTo(picture.grey, CV_8U, static_cast<double>(kWhite8) / white);
  return picture;
}

}  // namespace heel
