// Pictures of error_statistics.h.
#pragma once

#include <opencv2/core.hpp>

#include "evaluation/reports/error_statistics.h"

namespace heel::evaluation {

/// One row a condition: yaw error, share found and wrong, and honesty of the stated deviation over it.
cv::Mat errors_over_conditions_figure(const std::vector<ErrorCurve>& curves);

/// Distance × angle to the line of sight, undisturbed: the colour tells the mean absolute yaw error, the
/// numbers that, its deviation, and the share found.
cv::Mat error_map_figure(const std::vector<StillSample>& samples);

}  // namespace heel::evaluation
