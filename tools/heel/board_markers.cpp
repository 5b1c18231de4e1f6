#include "board_markers.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <opencv2/core.hpp>
#include <vector>

namespace heel::cli {
namespace {

constexpr int kSamples = 8;      // along each side of a square
constexpr float kInner = 0.7f;   // of the side: beyond it, a blurred edge reaches into the square
constexpr double kMarked = 0.2;  // of the difference of black and white: plain squares vary less
constexpr std::size_t kColours = 2;

/// Grey values inside a square between four corners.
std::vector<double> values_in(const cv::Mat& grey, const std::array<cv::Point2f, 4>& corners_px) {
  std::vector<double> values;
  for (int i = 0; i < kSamples * kSamples; ++i) {
    const int column = i % kSamples, row = i / kSamples;
    const float u = 0.5f + kInner * (static_cast<float>(column) / (kSamples - 1) - 0.5f);
    const float v = 0.5f + kInner * (static_cast<float>(row) / (kSamples - 1) - 0.5f);
    const cv::Point2f above = corners_px[0] * (1 - u) + corners_px[1] * u,
                      below = corners_px[2] * (1 - u) + corners_px[3] * u;
    const cv::Point at = above * (1 - v) + below * v;
    if (at.x >= 0 && at.y >= 0 && at.x < grey.cols && at.y < grey.rows)
      values.push_back(grey.at<std::uint8_t>(at));
  }
  return values;
}

double deviation_of(const std::vector<double>& values) {
  cv::Scalar mean, deviation;
  cv::meanStdDev(values, mean, deviation);
  return deviation[0];
}

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

bool has_markers(const cv::Mat& grey, const FoundCorners& found) {
  std::array<std::vector<double>, kColours> deviations;
  std::vector<double> all;
  const int width = found.seen.width;
  for (int row = 0; row + 1 < found.seen.height; ++row) {
    for (int column = 0; column + 1 < width; ++column) {
      const auto corner = [&](int down, int along) {
        return found.corners_px[static_cast<std::size_t>((row + down) * width + column + along)];
      };
      const std::vector<double> values =
          values_in(grey, {corner(0, 0), corner(0, 1), corner(1, 0), corner(1, 1)});
      if (values.empty()) continue;
      deviations[static_cast<std::size_t>(row + column) % kColours].push_back(deviation_of(values));
      all.insert(all.end(), values.begin(), values.end());
    }
  }
  if (deviations[0].empty() || deviations[1].empty()) return false;
  std::sort(all.begin(), all.end());
  const double contrast = all[all.size() * 9 / 10] - all[all.size() / 10];
  return std::max(median_of(deviations[0]), median_of(deviations[1])) > kMarked * contrast;
}

}  // namespace heel::cli
