// The view a template is taught from, as a picture and one line that a script can read.
#pragma once

#include <string>

#include "sim/scene/scenario.h"

namespace heel::sim {

/// Writes the reference view of the scenario's person from `distance_m` and prints
/// "roi=X,Y,W,H distance=M". Throws heel::Error when the back does not fit or the file cannot be written.
void write_still(const Scenario& scenario, const std::string& path, double distance_m);

}  // namespace heel::sim
