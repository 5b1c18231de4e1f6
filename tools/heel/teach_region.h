// The region of a template as people write it.
#pragma once

#include <vector>

#include "heel/camera_model.h"
#include "heel/features.h"

namespace heel::cli {

/// `roi`: X,Y,W,H. Throws heel::Error unless it lies in the camera's picture.
Region region_of(const std::vector<int>& roi, const CameraModel& camera);

}  // namespace heel::cli
