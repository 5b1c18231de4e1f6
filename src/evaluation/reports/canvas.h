// What figures are drawn on: lines, dots, bars and text, drawn twice as large and reduced, so that they come
// out smooth. Places and sizes are pixels of the finished picture; text stands on its baseline.
#pragma once

#include <opencv2/core.hpp>
#include <string>

namespace heel::evaluation {

inline const cv::Scalar kInk(40, 40, 40);
inline const cv::Scalar kGrid(225, 225, 225);

/// The distance of grid lines, 1, 2 or 5 times a power of ten, that cuts `size` into at most `wanted` parts.
double nice_step(double size, int wanted);

class Canvas {
 public:
  enum class Align { Left, Centre, Right };

  Canvas(int width_px, int height_px);

  void line(cv::Point2d a, cv::Point2d b, const cv::Scalar& bgr, double width_px);
  void dot(cv::Point2d at, const cv::Scalar& bgr, double radius_px);
  void box(cv::Rect2d area, const cv::Scalar& bgr);
  void bar(cv::Rect2d area, const cv::Scalar& bgr);
  void text(const std::string& text, cv::Point2d at, double size, Align align, bool bold = false);
  /// Text running upwards, centred on `at`.
  void text_upwards(const std::string& text, cv::Point2d at, double size);
  static double text_width_px(const std::string& text, double size);

  cv::Mat reduced() const;

 private:
  cv::Mat picture_;
};

}  // namespace heel::evaluation
