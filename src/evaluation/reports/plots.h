// The figures: heel writes the numbers, tools/plots draws them with Python's matplotlib.
#pragma once

#include <string>
#include <vector>

namespace heel::evaluation {

/// Has the program `plots` draw, with the arguments of its own help: a folder, or a JSON file and a picture.
/// It is HEEL_PLOTS, or share/heel/plots/plots beside the folder of this program (in the build folder that is
/// a link to tools/plots). Returns an empty text, or why nothing is drawn where something is not installed,
/// for people, with the name of the Debian package. Throws heel::Error when it could not draw these numbers.
[[nodiscard]] std::string draw_figures(const std::vector<std::string>& arguments);

}  // namespace heel::evaluation
