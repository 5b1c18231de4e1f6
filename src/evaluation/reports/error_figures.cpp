#include "evaluation/reports/error_figures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <opencv2/imgproc.hpp>

#include "evaluation/reports/canvas.h"
#include "evaluation/reports/plot.h"
#include "evaluation/reports/style.h"

namespace heel::evaluation {
namespace {

constexpr int kErrorPanelWidth_px = 420, kErrorPanelHeight_px = 250;

cv::Mat yaw_panel(const ErrorCurve& curve, const std::string& x_label) {
  Series mean{"outwards", kBlue, {}, 1.6, false}, absolute{"mean absolute", kOrange, {}, 1.6, false};
  Series p95{"95 %", kGrey, {}, 1.2, false};
  for (const ErrorBin& bin : curve.bins) {
    if (bin.found == 0) continue;
    mean.points.emplace_back(bin.middle, kDeg * bin.yaw_outward_mean_rad);
    absolute.points.emplace_back(bin.middle, kDeg * bin.yaw_mean_abs_rad);
    p95.points.emplace_back(bin.middle, kDeg * bin.yaw_p95_rad);
  }
  return plot({"yaw error", x_label, "degrees", false, false, {}}, {p95, absolute, mean}, kErrorPanelWidth_px,
              kErrorPanelHeight_px);
}

cv::Mat share_panel(const ErrorCurve& curve, const std::string& x_label) {
  Series found{"found", kGreen, {}, 1.6, false}, wrong{"of these wrong", kRed, {}, 1.6, false};
  Series certainty{"certainty", kOrange, {}, 1.6, false};
  for (const ErrorBin& bin : curve.bins) {
    found.points.emplace_back(bin.middle, bin.share_found());
    if (bin.found == 0) continue;
    wrong.points.emplace_back(bin.middle, bin.share_wrong());
    certainty.points.emplace_back(bin.middle, bin.certainty);
  }
  return plot({"found, wrong, certainty", x_label, "share", false, true, {}}, {found, certainty, wrong},
              kErrorPanelWidth_px, kErrorPanelHeight_px);
}

/// log10 of the mean normalised error squared: 0 is honest, 1 ten times too much.
cv::Mat honesty_panel(const ErrorCurve& curve, const std::string& x_label) {
  Series yaw{"yaw", kBlue, {}, 1.6, false}, t_x{"t_x", kGreen, {}, 1.6, false};
  Series t_z{"t_z", kOrange, {}, 1.6, false}, honest{"honest", kGrey, {}, 1.2, false};
  for (const ErrorBin& bin : curve.bins) {
    if (bin.found == 0) continue;
    yaw.points.emplace_back(bin.middle, std::log10(std::max(bin.yaw_nees, 1e-3)));
    t_x.points.emplace_back(bin.middle, std::log10(std::max(bin.t_x_nees, 1e-3)));
    t_z.points.emplace_back(bin.middle, std::log10(std::max(bin.t_z_nees, 1e-3)));
    honest.points.emplace_back(bin.middle, 0.0);
  }
  return plot({"log10 of (error / sigma) squared", x_label, "log10", false, false, {}},
              {honest, yaw, t_x, t_z}, kErrorPanelWidth_px, kErrorPanelHeight_px);
}

/// White at nothing, through yellow to dark red at `most` and beyond.
cv::Scalar heat(double value, double most) {
  const double f = std::clamp(value / most, 0.0, 1.0);
  return {235.0 * (1.0 - f), 245.0 - 170.0 * f, 250.0 - 40.0 * f};
}

}  // namespace

cv::Mat errors_over_conditions_figure(const std::vector<ErrorCurve>& curves) {
  std::vector<cv::Mat> rows;
  for (const ErrorCurve& curve : curves) {
    if (curve.bins.size() < 2) continue;
    if (curve.condition == "shirt") continue;  // no axis: it stands in the table
    const std::string label = curve.condition + (curve.unit.empty() ? "" : " in " + curve.unit);
    cv::Mat row;
    cv::hconcat(
        std::vector<cv::Mat>{yaw_panel(curve, label), share_panel(curve, label), honesty_panel(curve, label)},
        row);
    rows.push_back(row);
  }
  cv::Mat out;
  if (!rows.empty()) cv::vconcat(rows, out);
  return out;
}

cv::Mat error_map_figure(const std::vector<StillSample>& samples) {
  constexpr std::array kDistances{0.9, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0, 5.6};
  constexpr std::array kAngles{-80, -60, -45, -30, -15, 0, 15, 30, 45, 60, 80};
  constexpr double kCellWidth = 76, kCellHeight = 46, kLeft = 110, kTop = 60, kBottom = 60, kMost_deg = 20.0;
  const auto columns = static_cast<double>(kAngles.size() - 1),
             rows = static_cast<double>(kDistances.size() - 1);
  Canvas canvas(static_cast<int>(kLeft + columns * kCellWidth + 20),
                static_cast<int>(kTop + rows * kCellHeight + kBottom));
  canvas.text("Yaw error in degrees (mean, +- deviation) and share found, undisturbed",
              {kLeft + 0.5 * columns * kCellWidth, 26}, 0.56, Canvas::Align::Centre, true);
  char text[64];
  for (std::size_t r = 0; r + 1 < kDistances.size(); ++r) {
    const double y = kTop + static_cast<double>(r) * kCellHeight;
    std::snprintf(text, sizeof text, "%.1f-%.1f m", kDistances[r], kDistances[r + 1]);
    canvas.text(text, {kLeft - 8, y + 0.6 * kCellHeight}, 0.42, Canvas::Align::Right);
    for (std::size_t c = 0; c + 1 < kAngles.size(); ++c) {
      const double x = kLeft + static_cast<double>(c) * kCellWidth;
      const ErrorBin bin = error_bin("", 0.0, samples, [&](const StillSample& s) {
        const double angle = kDeg * s.aspect_rad();
        return s.undisturbed() && s.shirt == "bold" && s.true_z_m >= kDistances[r] &&
               s.true_z_m < kDistances[r + 1] && angle >= kAngles[c] && angle < kAngles[c + 1];
      });
      const cv::Rect2d cell(x, y, kCellWidth, kCellHeight);
      if (bin.found > 0) {
        canvas.bar(cell, heat(kDeg * bin.yaw_mean_abs_rad, kMost_deg));
        const bool wide = std::max(std::abs(bin.yaw_mean_rad), bin.yaw_deviation_rad) * kDeg >= 9.95;
        std::snprintf(text, sizeof text, wide ? "%+.0f +-%.0f" : "%+.1f +-%.1f", kDeg * bin.yaw_mean_rad,
                      kDeg * bin.yaw_deviation_rad);
        canvas.text(text, {x + 0.5 * kCellWidth, y + 19}, 0.36, Canvas::Align::Centre);
      }
      if (bin.pictures > 0) {
        std::snprintf(text, sizeof text, "%.0f %%", 100.0 * bin.share_found());
        canvas.text(text, {x + 0.5 * kCellWidth, y + 37}, 0.36, Canvas::Align::Centre);
      }
      canvas.box(cell, kGrid);
    }
  }
  for (std::size_t c = 0; c < kAngles.size(); ++c) {
    std::snprintf(text, sizeof text, "%d", kAngles[c]);
    canvas.text(text, {kLeft + static_cast<double>(c) * kCellWidth, kTop + rows * kCellHeight + 18}, 0.42,
                Canvas::Align::Centre);
  }
  canvas.text("angle of the back to the line of sight in degrees",
              {kLeft + 0.5 * columns * kCellWidth, kTop + rows * kCellHeight + 42}, 0.46,
              Canvas::Align::Centre);
  return canvas.reduced();
}

}  // namespace heel::evaluation
