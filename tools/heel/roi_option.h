// The option --roi: the rectangle of the back, in pixels of the upright picture.
#pragma once

#include <string>
#include <vector>

#include "heel/camera_model.h"
#include "heel/features.h"

namespace heel::cli {

/// Sets the region that the text names. Gives what was expected where it names none; empty: it does.
std::string read_roi(const std::string& text, const CameraModel& camera, Region& region);

/// `words`: what the command line gave, "X,Y,W,H" or four numbers. Throws heel::Error with the form that is
/// expected, and for the forms of other programs with the same rectangle in it.
Region parse_roi(const std::vector<std::string>& words, const CameraModel& camera);

}  // namespace heel::cli
