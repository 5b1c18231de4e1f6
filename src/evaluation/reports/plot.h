// Plain line plots: axes with units, grid, and a legend beneath the title, where it covers no curve; drawn
// twice as large and reduced, so that lines and text come out smooth.
#pragma once

#include <limits>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace heel::evaluation {

struct Series {
  std::string name;  ///< empty: not in the legend; neither is a series without points
  cv::Scalar bgr;
  std::vector<cv::Point2d> points;  ///< NaN breaks the line
  double width_px = 1.6;
  bool dots = false;  ///< single points instead of a line
};

struct Span {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  double size() const { return high - low; }
  bool empty() const { return !(low <= high); }
};

struct Axes {
  std::string title;
  std::string x_label;
  std::string y_label;
  bool equal_scale = false;  ///< one metre is as long in both directions
  bool y_from_zero = false;
  Span x;  ///< shown at least; empty: as far as the points reach
};

/// A picture of `width` × `height` pixels.
cv::Mat plot(const Axes& axes, const std::vector<Series>& series, int width_px, int height_px);

}  // namespace heel::evaluation
