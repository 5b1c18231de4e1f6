// Drawing of figures: heel writes the numbers, the program tools/plots/plots draws them with matplotlib.
#pragma once

#include <string>
#include <vector>

namespace heel::evaluation {

/// Runs `plots` with these arguments: a folder, or a JSON file and a picture. HEEL_PLOTS names the program;
/// by default it is ../share/heel/plots/plots, seen from this program's folder, installed or in the build
/// folder. Returns an empty text when it has drawn, and one line with the reason where the program, Python or
/// matplotlib is not installed. Throws heel::Error when the program refuses the numbers.
[[nodiscard]] std::string draw_figures(const std::vector<std::string>& arguments);

}  // namespace heel::evaluation
