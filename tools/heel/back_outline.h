// Where in a picture the back of a person is, proposed from body proportions.
#pragma once

#include <opencv2/core/mat.hpp>

#include "core/config.h"
#include "heel/camera_model.h"
#include "heel/features.h"

namespace heel::cli {

struct Person {
  double distance_m = 0.0;  ///< from the camera, along its view
  double height_m = 0.0;
};

/// The back, without arms, collar and hem, of a person who stands upright with the back to the camera: by the
/// camera's height and pitch, moved by up to a hand's width to where the features are. Clipped to the
/// picture; empty where less than half of it is in the picture. `camera` is the picture's.
Region proposed_back(const cv::Mat& grey, const CameraModel& camera, const CameraConfig& mount,
                     const Person& person);

}  // namespace heel::cli
