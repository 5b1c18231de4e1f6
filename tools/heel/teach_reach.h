// Measures and prints how far a taught shirt will be found.
#pragma once

#include "heel/camera_model.h"
#include "heel/shirt_template.h"

namespace heel::cli {

/// Ends after `longest_s` with what it has measured by then; 0: measures and prints nothing. Shows its
/// progress on stderr when that is a terminal.
void print_reach(const ShirtTemplate& shirt, const CameraModel& robot_camera, double longest_s);

}  // namespace heel::cli
