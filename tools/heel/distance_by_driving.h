// The distance of a person who stands still, from how much smaller the shirt becomes when the robot drives
// back.
#pragma once

#include "core/config.h"
#include "heel/shirt_template.h"

namespace heel::cli {

struct DrivenDistance {
  double distance_m = 0.0;  ///< from the camera to the back, where the view of the template was taken
  double sigma_m = 0.0;     ///< one standard deviation, by that of the pose
  double driven_m = 0.0;    ///< backwards, by odometry
};

/// Drives half a metre back, slowly, and searches the shirt from there. The robot stands at the place where
/// the view of `shirt`, of which the distance is not known, was taken. It is stopped and closed whatever
/// happens; a bumper, a stall or an interrupt stops it before. Throws heel::Error when it could not drive, or
/// the shirt is not found from there.
DrivenDistance distance_by_driving_back(const ShirtTemplate& shirt, const Config& config);

}  // namespace heel::cli
