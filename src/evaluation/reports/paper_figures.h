// The paper's Figures 1 … 8 (M. Burke and W. Brink, PRASA 2010) on our data.
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "evaluation/metrics/metrics.h"
#include "evaluation/reports/still_samples.h"

namespace heel::evaluation {

struct StepFigure {
  std::string title, x_label, y_label;
  std::string truth_name = "true";
};
/// Figures 2 … 6: mean ± one deviation over the commanded value beside the truth, and beneath it the
/// certainty with the share of pictures in which the shirt was found.
cv::Mat step_figure(const StepFigure& what, const std::vector<Step>& steps);

/// Figure 1: DIR/hard.csv and the pictures beside it, with the recovered quadrilaterals; empty when absent.
cv::Mat hard_figure(const std::string& directory);

/// Figure 7: the robot set down beside a person's straight line at another heading: both paths, distance from
/// the line and heading against it over the way walked.
cv::Mat response_figure(const MetricsCollector& run);

/// Figure 8: a long walk: the person's path, the robot's, and, where there is such a run, the path of a robot
/// that follows the position only.
cv::Mat walk_figure(const MetricsCollector& run, const MetricsCollector* position_only);

}  // namespace heel::evaluation
