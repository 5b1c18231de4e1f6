// Rows of still experiments as CSV.
#pragma once

#include <string>
#include <vector>

#include "evaluation/experiments/still_scene.h"

namespace heel::evaluation {

/// Throws heel::Error when it cannot be written.
void write_stills(const std::vector<StillRow>& rows, const std::string& path);

}  // namespace heel::evaluation
