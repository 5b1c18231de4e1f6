// Which of several pictures of the same is the sharpest.
#pragma once

#include <opencv2/core/mat.hpp>

namespace heel::cli {

/// Grows with the edges in a picture: for comparison only.
double sharpness_of(const cv::Mat& grey);

}  // namespace heel::cli
