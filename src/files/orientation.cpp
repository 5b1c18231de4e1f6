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

constexpr std::array<PictureTurn, 8> kTurns{
    {{false, 0}, {true, 0}, {false, 2}, {true, 2}, {true, 3}, {false, 1}, {true, 1}, {false, 3}}};

}  // namespace

cv::Mat turned_picture(const cv::Mat& grey, const PictureTurn& turn) {
  if (!turn.any()) return grey;
  const bool swapped = turn.swaps_sides();
  cv::Mat turned(swapped ? grey.cols : grey.rows, swapped ? grey.rows : grey.cols, CV_8UC1);
  turn_grey(turn, grey.data, static_cast<std::uint32_t>(grey.step), static_cast<std::uint32_t>(grey.cols),
            static_cast<std::uint32_t>(grey.rows), turned.data);
  return turned;
}

cv::Mat shown_picture(const cv::Mat& stored, int orientation) {
  if (orientation < 1 || orientation > static_cast<int>(kTurns.size())) return stored;
  return turned_picture(stored, kTurns[static_cast<std::size_t>(orientation - 1)]);
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
