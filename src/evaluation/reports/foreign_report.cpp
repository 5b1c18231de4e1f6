#include "evaluation/reports/foreign_report.h"

#include <filesystem>

#include "evaluation/reports/foreign_reliability.h"
#include "evaluation/reports/foreign_tables.h"

namespace heel::evaluation {
namespace {

/// The text that `text` makes of the file, or what is missing.
template <typename MakeText>
std::string text_of(const std::string& path, const char* what, MakeText text) {
  if (std::filesystem::exists(path)) return text(path);
  return std::string("Skipped: ") + what + ".\n";
}

}  // namespace

std::vector<SummaryPart> foreign_parts(const std::string& directory, const std::vector<StillSample>& own) {
  const std::string path = directory + "/foreign.csv";
  if (!std::filesystem::exists(path)) return {};
  const std::vector<ForeignSample> heel = read_foreign(path);
  write_reliability(heel, own, directory);
  return {
      {"foreign", "Bodies, cloth and prints of others", foreign_group_table(heel)},
      {"foreign-planar", "Beside planar matching on the same pictures",
       text_of(directory + "/foreign_planar.csv", "planar matching was not run",
               [&](const auto& file) { return foreign_method_table(heel, read_foreign(file)); })},
      {"foreign-markers", "Beside fiducial markers in the same scenes",
       text_of(directory + "/foreign_markers.csv",
               "no data of markers, or neither marker library is installed",
               [&](const auto& file) { return marker_table(read_markers(file), heel); })},
      {"foreign-false", "Searched for where it is not",
       text_of(directory + "/foreign_false.csv", "false detections were not counted", false_detection_table)},
  };
}

}  // namespace heel::evaluation
