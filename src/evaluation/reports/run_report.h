// A run's folder: what it came to as text and JSON, and the numbers of its figures.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "evaluation/metrics/metrics.h"

namespace heel::evaluation {

struct RunReport {
  std::string text;
  nlohmann::ordered_json json;
};

/// Writes summary.txt, summary.json and the CSV files of run_numbers.h; returns the summary. `failed` are the
/// criteria the run did not meet. Throws heel::Error.
RunReport write_run_report(const std::string& directory, const MetricsCollector& run,
                           const FollowMetrics& metrics, const std::vector<std::string>& failed);

}  // namespace heel::evaluation
