// The run in a few lines for people.
#pragma once

#include <string>
#include <vector>

#include "evaluation/metrics/metrics.h"

namespace heel::evaluation {

/// One "name  value" a line; `failed` are the criteria the run did not meet, named last.
std::string summary_text(const FollowMetrics& metrics, const std::vector<std::string>& failed);

}  // namespace heel::evaluation
