#include "evaluation/reports/run_report.h"

#include "evaluation/reports/run_numbers.h"
#include "evaluation/reports/summary.h"
#include "files/atomic_file.h"

namespace heel::evaluation {

RunReport write_run_report(const std::string& directory, const MetricsCollector& run,
                           const FollowMetrics& metrics, const std::vector<std::string>& failed) {
  RunReport report{summary_text(metrics, failed), to_json(metrics)};
  report.json["failed"] = failed;
  write_file_atomically(directory + "/summary.txt", report.text);
  write_file_atomically(directory + "/summary.json", report.json.dump(2) + "\n");
  write_run_numbers(directory, run, metrics);
  return report;
}

}  // namespace heel::evaluation
