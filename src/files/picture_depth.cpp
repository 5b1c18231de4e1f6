#include "files/picture_depth.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

namespace heel {
namespace {

constexpr int kWhite8 = 255, kWhite16 = 65535;
constexpr std::size_t kPixelsPerHotOne = 10000;  // one hot pixel of a small picture, 30 of 640 x 480

/// The largest value of the fewest bits that hold `largest`.
int white_that_holds(int largest) {
  for (const int bits : {8, 10, 12, 14}) {
    if (largest < 1 << bits) return (1 << bits) - 1;
  }
  return kWhite16;
}

/// The largest value of the picture but for its hot pixels: a few that a sensor or a program sets to the
/// largest value there is.
struct LargestValue {
  int value = 0;
  int hot_pixels = 0;  ///< above it
};

LargestValue largest_but_hot(const cv::Mat& raw) {
  double largest = 0.0;
  cv::minMaxLoc(raw, nullptr, &largest);
  if (raw.depth() != CV_16U) return {static_cast<int>(largest), 0};
  std::vector<int> pixels(std::size_t{kWhite16} + 1);
  for (int y = 0; y < raw.rows; ++y)
    for (int x = 0; x < raw.cols; ++x) ++pixels[raw.at<std::uint16_t>(y, x)];
  const int most_hot = std::max(1, static_cast<int>(raw.total() / kPixelsPerHotOne));
  LargestValue but_hot{static_cast<int>(largest), 0};
  int above = 0;
  for (int value = but_hot.value; value > 0 && above <= most_hot; --value) {
    const int count = pixels[static_cast<std::size_t>(value)];
    // They count as hot only where the picture has fewer bits without them.
    if (count > 0 && white_that_holds(value) < white_that_holds(but_hot.value)) but_hot = {value, above};
    above += count;
  }
  return but_hot;
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
  const LargestValue largest = largest_but_hot(raw);
  EightBitPicture picture;
  int& white = picture.white;
  white = stated_white;
  if (stated_white == 0 || largest.value > stated_white) {
    white = raw.depth() == CV_16U ? std::max(white_that_holds(largest.value), least_white) : file_white;
  }
  if (white != file_white) {
    picture.note = fmt::format(
        "{} bits a pixel, of which {} are used (largest value {}{}); white is {}",
        raw.depth() == CV_16U ? 16 : 8, bits_of(white), largest.value,
        largest.hot_pixels == 0 ? "" : fmt::format(", but for {} hot", largest.hot_pixels), white);
  }
  raw.convertTo(picture.grey, CV_8U, static_cast<double>(kWhite8) / white);
  return picture;
}

}  // namespace heel
