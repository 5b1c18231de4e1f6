// The view that a template is made from, as a picture file.
#pragma once

#include <string>

#include "sim/scene/scenario.h"

namespace heel::sim {

/// Writes the view of the scenario's standing person from `distance_m` and prints "roi=X,Y,W,H distance=M"
/// for scripts. Throws heel::Error when the back does not fit into the picture or the file cannot be written.
void write_reference_picture(const Scenario& scenario, const std::string& path, double distance_m);

}  // namespace heel::sim
