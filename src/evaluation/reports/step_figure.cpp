// Figures 2 … 6.
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "evaluation/reports/paper_figures.h"
#include "evaluation/reports/plot.h"
#include "evaluation/reports/style.h"

namespace heel::evaluation {
namespace {

constexpr int kStepWidth_px = 900, kValueHeight_px = 380, kCertaintyHeight_px = 230;

void add_bar(Series& bars, double x, double low, double high) {
  bars.points.emplace_back(x, low);
  bars.points.emplace_back(x, high);
  bars.points.emplace_back(kNaN, kNaN);
}

}  // namespace

cv::Mat step_figure(const StepFigure& what, const std::vector<Step>& steps) {
  Series truth{what.truth_name, kGrey, {}, 2.2, false};
  Series mean{"mean", kBlue, {}, 1.4, false};
  Series dots{"", kBlue, {}, 2.0, true};
  Series bars{"one deviation either way", kBlue, {}, 1.0, false};
  Series certainty{"90 % of pictures", kOrange, {}, 1.0, false};
  Series certainty_mean{"mean certainty", kOrange, {}, 1.8, false};
  Series found{"share found", kGreen, {}, 1.4, false};
  for (const Step& step : steps) {
    truth.points.emplace_back(step.at, step.truth);
    found.points.emplace_back(step.at, step.share_found());
    certainty_mean.points.emplace_back(step.at, step.certainty_mean);
    add_bar(certainty, step.at, step.certainty_low, step.certainty_high);
    if (step.found == 0) {
      mean.points.emplace_back(kNaN, kNaN);
      continue;
    }
    mean.points.emplace_back(step.at, step.mean);
    dots.points.emplace_back(step.at, step.mean);
    add_bar(bars, step.at, step.mean - step.deviation, step.mean + step.deviation);
  }
  const Span x = steps.empty() ? Span{} : Span{steps.front().at, steps.back().at};
  const Series reliable{"0.1: reliable", kGrey, {{x.low, 0.1}, {x.high, 0.1}}, 1.0, false};
  const cv::Mat above = plot({what.title, what.x_label, what.y_label, false, false, x},
                             {truth, bars, mean, dots}, kStepWidth_px, kValueHeight_px);
  const cv::Mat below =
      plot({"Certainty: inliers / template features", what.x_label, "0 ... 1", false, true, x},
           {reliable, found, certainty, certainty_mean}, kStepWidth_px, kCertaintyHeight_px);
  cv::Mat out;
  cv::vconcat(above, below, out);
  return out;
}

}  // namespace heel::evaluation
