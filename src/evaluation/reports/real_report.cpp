#include "evaluation/reports/real_report.h"

#include <cstdio>
#include <filesystem>

#include "files/csv_table.h"

namespace heel::evaluation {
namespace {

constexpr double kReliable = 0.1;

std::string pairs_text(const std::string& path) {
  if (!std::filesystem::exists(path)) return "Skipped: the Oxford pairs (no data; see HEEL_TEST_DATA).\n";
  const CsvTable table(path);
  std::string text = "| real pair | inliers | certainty | corner error |\n|---|---|---|---|\n";
  for (std::size_t i = 0; i < table.rows(); ++i) {
    char row[160];
    if (table.number(i, "found") != 0.0)
      std::snprintf(row, sizeof row, "| %s 1-%.0f | %.0f | %.2f | %.1f px |\n", table.text(i, "set").c_str(),
                    table.number(i, "to"), table.number(i, "inliers"), table.number(i, "certainty"),
                    table.number(i, "corner_error_px"));
    else
      std::snprintf(row, sizeof row, "| %s 1-%.0f | - | - | not found: %s |\n", table.text(i, "set").c_str(),
                    table.number(i, "to"), table.text(i, "reason").c_str());
    text += row;
  }
  return text;
}

std::string video_text(const std::string& path) {
  if (!std::filesystem::exists(path)) return "Skipped: the real video (no data; see HEEL_TEST_DATA).\n";
  const CsvTable table(path);
  int in_view = 0, reliable = 0, elsewhere = 0, false_alarms = 0;
  double sum = 0.0;
  for (std::size_t i = 0; i < table.rows(); ++i) {
    const double certainty = table.number(i, "certainty");
    if (table.number(i, "in_view") != 0.0) {
      ++in_view;
      sum += certainty;
      if (certainty > kReliable) ++reliable;
      continue;
    }
    // Half a second before and after, the back is partly in view.
    const double frame = table.number(i, "frame");
    if (frame > 910 && frame < 1200) continue;
    ++elsewhere;
    if (table.number(i, "found") != 0.0) ++false_alarms;
  }
  char text[240];
  std::snprintf(
      text, sizeof text,
      "Real video, a knitted back: certainty above 0.1 in %d of %d frames (mean %.2f); found in %d of %d "
      "frames that do not show it.\n",
      reliable, in_view, in_view > 0 ? sum / in_view : 0.0, false_alarms, elsewhere);
  return text;
}

}  // namespace

std::string real_text(const std::string& directory) {
  return pairs_text(directory + "/real_pairs.csv") + "\n" + video_text(directory + "/real_video.csv");
}

}  // namespace heel::evaluation
