// Pictures for people: the shirt found in a frame, and a template's region with its features.
#pragma once

#include <opencv2/core/mat.hpp>

#include "heel/flow.h"
#include "heel/shirt_template.h"

namespace heel::cli {

/// The frame with the template's outline where the pose puts it, the walking direction, and a view from
/// above. `camera` is the frame's.
cv::Mat draw_pose(const cv::Mat& grey, const PoseEstimate& pose, const ShirtTemplate& shirt,
                  const CameraModel& camera);

/// The region and what surrounds it, enlarged, with a circle of radius 2 sigma round each feature.
cv::Mat draw_template(const ShirtTemplate& shirt, const FeatureSet& features);

}  // namespace heel::cli
