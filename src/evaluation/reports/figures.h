// The figures of one run.
#pragma once

#include <opencv2/core.hpp>
#include <string>

#include "evaluation/metrics/metrics.h"

namespace heel::evaluation {

/// Both paths to scale, where they begin and end, and where the target was not found.
cv::Mat path_figure(const MetricsCollector& run, const FollowMetrics& metrics);
/// Yaw, t_x, t_z against the truth, certainty, and what the robot was told, over time.
cv::Mat errors_figure(const MetricsCollector& run);
/// Up to twelve frames of those kept in DIR/frames, evenly over the run, with the recovered quadrilateral of
/// DIR/shirt.heel; empty when either is absent.
cv::Mat frames_figure(const std::string& directory);

}  // namespace heel::evaluation
