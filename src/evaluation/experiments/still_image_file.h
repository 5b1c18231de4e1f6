// The rows of experiments with still images as CSV.
#pragma once

#include <string>
#include <vector>

#include "evaluation/experiments/still_image_scene.h"

namespace heel::evaluation {

/// Throws heel::Error when it cannot be written.
void write_still_images(const std::vector<StillImageRow>& rows, const std::string& path);

}  // namespace heel::evaluation
