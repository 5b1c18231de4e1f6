// A folder of experiments → every figure, its numbers as CSV, and summary.md.
#pragma once

#include <string>

namespace heel::evaluation {

/// Whether `directory` holds rows of `heel experiment`, or runs in runs/NAME.
bool holds_experiments(const std::string& directory);

/// Draws what there is: fig1 … fig8, errors_*.png, and writes summary.md. Returns the summary. Throws
/// heel::Error.
std::string report_experiments(const std::string& directory);

}  // namespace heel::evaluation
