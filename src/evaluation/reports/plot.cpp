#include "evaluation/reports/plot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "evaluation/reports/canvas.h"

namespace heel::evaluation {
namespace {

constexpr int kLeft = 78, kRight = 18, kTop = 62, kBottom = 54;
constexpr double kLegendYPx = 46;

void widen(Span& span, double value) {
  span = {std::min(span.low, value), std::max(span.high, value)};
}

void find_spans(const Axes& axes, const std::vector<Series>& series, const cv::Rect2d& area, Span& x,
                Span& y) {
  x = axes.x;
  y = {};
  if (axes.y_from_zero) widen(y, 0.0);
  for (const Series& s : series)
    for (const cv::Point2d& p : s.points) {
      if (!std::isfinite(p.x) || !std::isfinite(p.y)) continue;
      widen(x, p.x);
      widen(y, p.y);
    }
  if (x.empty()) x = {0, 1};
  if (y.empty()) y = {0, 1};
  const double pad_x = axes.equal_scale ? 0.06 * x.size() + 0.3 : 0.0;
  const double pad_y = axes.equal_scale ? 0.06 * y.size() + 0.3 : 0.06 * y.size() + 1e-6;
  x = {x.low - pad_x, x.high + pad_x + 1e-9};
  y = {y.low - (axes.y_from_zero ? 0.0 : pad_y), y.high + pad_y};
  if (!axes.equal_scale) return;
  const double per_px = std::max(x.size() / area.width, y.size() / area.height);
  const double grow_x = 0.5 * (per_px * area.width - x.size());
  const double grow_y = 0.5 * (per_px * area.height - y.size());
  x = {x.low - grow_x, x.high + grow_x};
  y = {y.low - grow_y, y.high + grow_y};
}

void draw_grid(Canvas& canvas, const Axes& axes, const cv::Rect2d& area, const Span& x, const Span& y) {
  char text[32];
  const double step_x = nice_step(x.size(), 10);
  for (double v = std::ceil(x.low / step_x) * step_x; v <= x.high; v += step_x) {
    const double px = area.x + (v - x.low) / x.size() * area.width;
    canvas.line({px, area.y}, {px, area.y + area.height}, kGrid, 0.5);
    std::snprintf(text, sizeof text, "%g", std::abs(v) < 1e-9 ? 0.0 : v);
    canvas.text(text, {px, area.y + area.height + 17}, 0.42, Canvas::Align::Centre);
  }
  const double step_y = axes.equal_scale ? step_x : nice_step(y.size(), 5);
  for (double v = std::ceil(y.low / step_y) * step_y; v <= y.high; v += step_y) {
    const double py = area.y + area.height - (v - y.low) / y.size() * area.height;
    canvas.line({area.x, py}, {area.x + area.width, py}, kGrid, 0.5);
    std::snprintf(text, sizeof text, "%g", std::abs(v) < 1e-9 ? 0.0 : v);
    canvas.text(text, {area.x - 7, py + 5}, 0.42, Canvas::Align::Right);
  }
  canvas.box(area, kInk);
  canvas.text(axes.title, {area.x + 0.5 * area.width, 24}, 0.56, Canvas::Align::Centre, true);
  canvas.text(axes.x_label, {area.x + 0.5 * area.width, area.y + area.height + 40}, 0.46,
              Canvas::Align::Centre);
  canvas.text_upwards(axes.y_label, {20, area.y + 0.5 * area.height}, 0.46);
}

/// One row, centred over the axes.
void draw_legend(Canvas& canvas, const cv::Rect2d& area, const std::vector<Series>& series) {
  constexpr double kTextSize = 0.42, kSample_px = 26, kGap_px = 8, kBetween_px = 26;
  std::vector<const Series*> named;
  double width = -kBetween_px;
  for (const Series& s : series) {
    if (s.name.empty() || s.points.empty()) continue;
    named.push_back(&s);
    width += kSample_px + kGap_px + Canvas::text_width_px(s.name, kTextSize) + kBetween_px;
  }
  double x = area.x + 0.5 * (area.width - width);
  for (const Series* s : named) {
    if (s->dots)
      canvas.dot({x + 0.5 * kSample_px, kLegendYPx}, s->bgr, 3.2);
    else
      canvas.line({x, kLegendYPx}, {x + kSample_px, kLegendYPx}, s->bgr, s->width_px);
    x += kSample_px + kGap_px;
    canvas.text(s->name, {x, kLegendYPx + 5}, kTextSize, Canvas::Align::Left);
    x += Canvas::text_width_px(s->name, kTextSize) + kBetween_px;
  }
}

}  // namespace

cv::Mat plot(const Axes& axes, const std::vector<Series>& series, int width_px, int height_px) {
  Canvas canvas(width_px, height_px);
  const cv::Rect2d area(kLeft, kTop, width_px - kLeft - kRight, height_px - kTop - kBottom);
  Span x, y;
  find_spans(axes, series, area, x, y);
  draw_grid(canvas, axes, area, x, y);
  const auto place = [&](const cv::Point2d& p) {
    return cv::Point2d(area.x + (p.x - x.low) / x.size() * area.width,
                       area.y + area.height - (p.y - y.low) / y.size() * area.height);
  };
  for (const Series& s : series)
    for (std::size_t i = 0; i < s.points.size(); ++i) {
      const bool whole = std::isfinite(s.points[i].x) && std::isfinite(s.points[i].y);
      if (whole && s.dots) canvas.dot(place(s.points[i]), s.bgr, 1.5 * s.width_px);
      if (!whole || s.dots || i == 0 || !std::isfinite(s.points[i - 1].y)) continue;
      canvas.line(place(s.points[i - 1]), place(s.points[i]), s.bgr, s.width_px);
    }
  draw_legend(canvas, area, series);
  return canvas.reduced();
}

}  // namespace heel::evaluation
