#include "files/orientation.h"

#include <array>
#include <cmath>
#include <opencv2/core.hpp>

namespace heel {
namespace {

/// The signs of a, b, c, d for the orientations 1 to 8.
constexpr std::array<std::array<int, 4>, 8> kSigns{{{1, 0, 0, 1},
                                                    {-1, 0, 0, 1},
                                                    {-1, 0, 0, -1},
                                                    {1, 0, 0, -1},
                                                    {0, 1, 1, 0},
                                                    {0, 1, -1, 0},
                                                    {0, -1, -1, 0},
                                                    {0, -1, 1, 0}}};

}  // namespace

cv::Mat shown_picture(const cv::Mat& stored, int orientation) {
  cv::Mat shown;
  switch (orientation) {
    case 2:
      cv::flip(stored, shown, 1);
      return shown;
    case 3:
      cv::rotate(stored, shown, cv::ROTATE_180);
      return shown;
    case 4:
      cv::flip(stored, shown, 0);
      return shown;
    case 5:
      cv::transpose(stored, shown);
      return shown;
    case 6:
      cv::rotate(stored, shown, cv::ROTATE_90_CLOCKWISE);
      return shown;
    case 7:
      cv::transpose(stored, shown);
      cv::rotate(shown, shown, cv::ROTATE_180);
      return shown;
    case 8:
      cv::rotate(stored, shown, cv::ROTATE_90_COUNTERCLOCKWISE);
      return shown;
    default:
      return stored;
  }
}

int orientation_of_display_matrix(std::span<const std::int32_t, 9> matrix) {
  const std::array<double, 4> abcd{static_cast<double>(matrix[0]), static_cast<double>(matrix[1]),
                                   static_cast<double>(matrix[3]), static_cast<double>(matrix[4])};
  // Also a matrix that scales the picture says how it is turned.
  const double scale = std::max(std::hypot(abcd[0], abcd[1]), std::hypot(abcd[2], abcd[3]));
  if (scale == 0.0) return 0;
  for (std::size_t i = 0; i < kSigns.size(); ++i) {
    double largest = 0.0;
    for (std::size_t k = 0; k < 4; ++k) largest = std::max(largest, std::abs(abcd[k] / scale - kSigns[i][k]));
    if (largest < 0.05) return static_cast<int>(i) + 1;
  }
  return 0;
}

}  // namespace heel
