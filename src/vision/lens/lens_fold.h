// Whether a distortion is one that a lens can have: one pixel for each direction inside the picture.
#pragma once

#include <optional>

#include "heel/camera_model.h"

namespace heel {

/// Where the distortion folds inside the picture, so that two directions are seen at one pixel: the distance
/// from the principal point, px. Nothing when it does not.
std::optional<double> fold_in_picture_px(const CameraModel& camera);

}  // namespace heel
