// Pictures for measurements: a real one where the test data exist, otherwise textured noise; and worst cases.
#pragma once

#include <opencv2/core.hpp>

#include "heel/flow.h"

namespace heel::evaluation {

/// A 640 × 480 real scene (graf, image 1, resized); blurred noise where the test data are absent.
cv::Mat textured_image(cv::Size size = {640, 480});
cv::Mat noise_image(cv::Size size = {640, 480});
/// Blobs of one size, side by side: as many equally strong maxima as possible.
cv::Mat checkerboard_image(int period_px, cv::Size size = {640, 480});

FrameView view_of(const cv::Mat& grey);

}  // namespace heel::evaluation
