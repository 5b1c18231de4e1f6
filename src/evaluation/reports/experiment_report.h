// A folder of experiments: the numbers of every figure as CSV, and summary.md.
#pragma once

#include <string>

namespace heel::evaluation {

/// Whether `directory` holds rows of `heel experiment`, or runs in runs/NAME.
bool holds_experiments(const std::string& directory);

/// Writes the numbers of fig2 … fig8 and errors_*, and summary.md. Returns the summary. The other figures are
/// drawn from the rows of `heel experiment` themselves. Throws heel::Error.
std::string report_experiments(const std::string& directory);

}  // namespace heel::evaluation
