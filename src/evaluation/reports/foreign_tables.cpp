#include "evaluation/reports/foreign_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <set>

#include "files/csv_table.h"

namespace heel::evaluation {
namespace {

/// Three digits of at most four decimals, as printf writes them; "-" for what there is none of.
std::string three_digits(bool known, double value) {
  if (!known || std::isnan(value)) return "-";
  char text[40];
  std::snprintf(text, sizeof text, "%.3g", std::round(1e4 * value) / 1e4);
  return text;
}

std::string percent(std::size_t part, std::size_t whole) {
  return whole > 0 ? fmt::format("{:.0f} %", 100.0 * static_cast<double>(part) / static_cast<double>(whole))
                   : "–";
}

std::string score_row(const ForeignGroup& group) {
  const ForeignFigures& f = group.figures;
  std::string row = "| " + group.name + " |";
  const auto cell = [&](bool known, double value) { row += " " + three_digits(known, value) + " |"; };
  const bool any = f.found > 0, any_right = f.found > f.wrong;
  cell(true, static_cast<double>(f.pictures));
  cell(true, f.share(f.found));
  cell(true, f.share(f.sure));
  cell(true, static_cast<double>(f.wrong));
  cell(true, static_cast<double>(f.wrong_of_sure));
  for (const double yaw_deg : {f.yaw_mean_deg, f.yaw_median_deg, f.yaw_p95_deg}) cell(any, yaw_deg);
  cell(any, static_cast<double>(f.flips));
  cell(any, f.nees);
  cell(any_right, f.along_rms_m);
  cell(any_right, f.across_rms_m);
  cell(any, f.certainty_median);
  return row + "\n";
}

/// A group's name in the score table, and for readers.
const std::map<std::string, std::string>& readers_names() {
  static const std::map<std::string, std::string> names = {{"stills, 1-3 m, up to 45", "1 to 3 m, up to 45°"},
                                                           {"stills, 4 m, up to 30", "4 m, up to 30°"},
                                                           {"stills, 1-3 m, 60", "1 to 3 m, 60°"},
                                                           {"static", "other postures than the taught one"},
                                                           {"calm", "the taught posture, other folds"},
                                                           {"rigid", "the taught posture and folds"},
                                                           {"board", "a flat board"},
                                                           {"walk", "walking, frame after frame"}};
  return names;
}

std::string readers_name(const std::string& group) {
  const auto found = readers_names().find(group);
  return found == readers_names().end() ? group : found->second;
}

std::string group_row(const ForeignGroup& group) {
  const ForeignFigures& f = group.figures;
  std::string thirds;
  for (const double nees : f.nees_of_thirds)
    thirds += fmt::format("{}{:.1f}", thirds.empty() ? "" : ", ", nees);
  std::string row = fmt::format("| {} | {} | {} | {} | {} |", readers_name(group.name), f.pictures,
                                percent(f.sure, f.pictures), f.wrong, f.wrong_of_sure);
  if (f.found == 0) return row + " – | – | – | – | – | – | – | – |\n";
  row += fmt::format(" {:.1f}° | {:.1f}° | {:.1f}° | {} of {} |", f.yaw_mean_deg, f.yaw_median_deg,
                     f.yaw_p95_deg, f.flips, f.turned);
  return row + fmt::format(" {:.1f} | {} | {:.0f} mm | {:.0f} mm |\n", f.nees, thirds.empty() ? "–" : thirds,
                           1e3 * f.along_rms_m, 1e3 * f.across_rms_m);
}

std::vector<std::string> methods_of(const std::vector<ForeignSample>& samples) {
  std::vector<std::string> methods;
  for (const ForeignSample& s : samples)
    if (std::find(methods.begin(), methods.end(), s.method) == methods.end()) methods.push_back(s.method);
  return methods;
}

std::string method_row(const std::string& name, const std::vector<ForeignGroup>& groups) {
  std::string row = "| " + name + " |";
  for (std::size_t i = 0; i < groups.size() && i < 3; ++i) {
    const ForeignFigures& f = groups[i].figures;
    row += " " + percent(f.found, f.pictures) + " |";
    row += f.found > 0 ? fmt::format(" {:.1f}° | {:.1f}° |", f.yaw_mean_deg, f.yaw_median_deg) : " – | – |";
  }
  return row + "\n";
}

}  // namespace

std::string foreign_score_table(const std::vector<ForeignSample>& samples) {
  std::string text =
      "| group | pictures | found | sure | wrong | wrong_of_sure | yaw_mean | yaw_median | yaw_p95 | flips | "
      "e_over_s_2 | along_rms | across_rms | certainty_median "
      "|\n|---|---|---|---|---|---|---|---|---|---|---|"
      "---|---|---|\n";
  for (const ForeignGroup& group : foreign_groups(samples)) text += score_row(group);
  if (const auto walk = walk_figures(samples))
    text += fmt::format("walk: error changes by {:.3f} RMS, direction {:.3f}, over a stride {:.3f}\n",
                        walk->change_deg, walk->direction_deg, walk->stride_direction_deg);
  return text;
}

std::string foreign_group_table(const std::vector<ForeignSample>& samples) {
  std::string text =
      "| pictures of | how many | found, certainty ≥ 0.1 | wrong | wrong, certainty ≥ 0.1 | yaw error: mean "
      "| "
      "median | 95 % | wrong side | (error / σ)² | in each third by σ | off along the line of sight | across "
      "it |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const ForeignGroup& group : foreign_groups(samples)) text += group_row(group);
  if (const auto walk = walk_figures(samples))
    text += fmt::format(
        "\nWhile the person walks, the yaw error changes by {:.1f}° RMS from frame to frame. The yaw is "
        "{:.1f}° "
        "RMS off the direction of the path, its mean over a pair of strides {:.1f}°.\n",
        walk->change_deg, walk->direction_deg, walk->stride_direction_deg);
  return text;
}

std::string foreign_method_table(const std::vector<ForeignSample>& heel,
                                 const std::vector<ForeignSample>& others) {
  std::string text =
      "| method | 1 to 3 m, up to 45°: found | yaw mean | median | 4 m, up to 30°: found | yaw mean | median "
      "| "
      "1 to 3 m, 60°: found | yaw mean | median |\n|---|---|---|---|---|---|---|---|---|---|\n";
  text += method_row("heel", foreign_groups(heel));
  for (const std::string& method : methods_of(others)) {
    std::vector<ForeignSample> of_method;
    for (const ForeignSample& s : others)
      if (s.method == method) of_method.push_back(s);
    text += method_row(method, foreign_groups(of_method));
  }
  return text;
}

std::string false_detection_table(const std::string& path) {
  const CsvTable table(path);
  std::string text = "| searched for | in | frames or pictures | found |\n|---|---|---|---|\n";
  for (std::size_t row = 0; row < table.rows(); ++row)
    text += fmt::format("| {} | {} | {} | {} |\n", table.text(row, "searched_for"), table.text(row, "in"),
                        table.text(row, "pictures"), table.text(row, "found"));
  return text;
}

}  // namespace heel::evaluation
