// The parts of summary.md about the foreign sets.
#pragma once

#include <string>
#include <vector>

#include "evaluation/reports/still_samples.h"
#include "evaluation/reports/summary_part.h"

namespace heel::evaluation {

/// Of the files that `directory` holds: foreign.csv, foreign_planar.csv, foreign_markers.csv,
/// foreign_false.csv. None without foreign.csv; a part says so when its own file is missing. Writes the
/// numbers of the figure foreign_reliability; `own` are the own world's pictures beside them.
std::vector<SummaryPart> foreign_parts(const std::string& directory, const std::vector<StillSample>& own);

}  // namespace heel::evaluation
