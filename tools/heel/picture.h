// Pictures that show results: the shirt found in a frame, and a template's region with its features.
#pragma once

#include <opencv2/core/mat.hpp>

#include "heel/flow.h"
#include "heel/shirt_template.h"

namespace heel::cli {

/// The frame with the template's outline at the pose, and a view from above with the walking direction.
/// `camera` is the frame's.
cv::Mat draw_pose(const cv::Mat& grey, const PoseEstimate& pose, const ShirtTemplate& shirt,
                  const CameraModel& camera);

/// The region and its surroundings, enlarged, with a circle of radius 2 sigma around each feature.
cv::Mat draw_template(const ShirtTemplate& shirt, const FeatureSet& features);

}  // namespace heel::cli
