#include "evaluation/reports/canvas.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace heel::evaluation {
namespace {

constexpr int kScale = 2;  ///< drawn larger, then reduced
constexpr int kShift = 4;  ///< OpenCV's fixed-point places
constexpr int kThin = 2, kBold = 3;

cv::Point fixed(cv::Point2d p) {
  return {static_cast<int>(std::lround(p.x * kScale * (1 << kShift))),
          static_cast<int>(std::lround(p.y * kScale * (1 << kShift)))};
}

cv::Size extent_of(const std::string& text, double size, int thickness, int& baseline) {
  return cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, size * kScale, thickness, &baseline);
}

}  // namespace

double nice_step(double size, int wanted) {
  const double raw = size / wanted;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= raw) return factor * power;
  return 10.0 * power;
}

Canvas::Canvas(int width_px, int height_px)
    : picture_(height_px * kScale, width_px * kScale, CV_8UC3, cv::Scalar::all(255)) {}

void Canvas::line(cv::Point2d a, cv::Point2d b, const cv::Scalar& bgr, double width_px) {
  cv::line(picture_, fixed(a), fixed(b), bgr, std::max(1, static_cast<int>(std::lround(width_px * kScale))),
           cv::LINE_AA, kShift);
}

void Canvas::dot(cv::Point2d at, const cv::Scalar& bgr, double radius_px) {
  cv::circle(picture_, fixed(at), static_cast<int>(radius_px * kScale * (1 << kShift)), bgr, cv::FILLED,
             cv::LINE_AA, kShift);
}

void Canvas::box(cv::Rect2d area, const cv::Scalar& bgr) {
  cv::rectangle(picture_, cv::Point(area.tl() * kScale), cv::Point(area.br() * kScale), bgr, kScale,
                cv::LINE_AA);
}

void Canvas::bar(cv::Rect2d area, const cv::Scalar& bgr) {
  cv::rectangle(picture_, fixed(area.tl()), fixed(area.br()), bgr, cv::FILLED, cv::LINE_AA, kShift);
}

void Canvas::text(const std::string& text, cv::Point2d at, double size, Align align, bool bold) {
  const int thickness = bold ? kBold : kThin;
  int baseline = 0;
  const cv::Size extent = extent_of(text, size, thickness, baseline);
  double x = at.x * kScale;
  if (align == Align::Centre) x -= 0.5 * extent.width;
  if (align == Align::Right) x -= extent.width;
  cv::putText(picture_, text, cv::Point(static_cast<int>(x), static_cast<int>(at.y * kScale)),
              cv::FONT_HERSHEY_SIMPLEX, size * kScale, kInk, thickness, cv::LINE_AA);
}

void Canvas::text_upwards(const std::string& text, cv::Point2d at, double size) {
  int baseline = 0;
  const cv::Size extent = extent_of(text, size, kThin, baseline);
  cv::Mat label(extent.height + 2 * baseline, extent.width, CV_8UC3, cv::Scalar::all(255));
  cv::putText(label, text, {0, extent.height + baseline / 2}, cv::FONT_HERSHEY_SIMPLEX, size * kScale, kInk,
              kThin, cv::LINE_AA);
  cv::rotate(label, label, cv::ROTATE_90_COUNTERCLOCKWISE);
  const cv::Point corner(static_cast<int>(at.x * kScale) - label.cols / 2,
                         std::max(0, static_cast<int>(at.y * kScale) - label.rows / 2));
  const cv::Rect place = cv::Rect(corner, label.size()) & cv::Rect({0, 0}, picture_.size());
  label(cv::Rect({0, 0}, place.size())).copyTo(picture_(place));
}

double Canvas::text_width_px(const std::string& text, double size) {
  int baseline = 0;
  return extent_of(text, size, kThin, baseline).width / static_cast<double>(kScale);
}

cv::Mat Canvas::reduced() const {
  cv::Mat out;
  cv::resize(picture_, out, {}, 1.0 / kScale, 1.0 / kScale, cv::INTER_AREA);
  return out;
}

}  // namespace heel::evaluation
