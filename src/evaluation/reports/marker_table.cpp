// Fiducial markers beside heel in the same scenes.
#include <fmt/format.h>

#include <cmath>
#include <map>
#include <set>

#include "evaluation/reports/foreign_tables.h"
#include "files/csv_table.h"

namespace heel::evaluation {
namespace {

struct MarkerGroup {
  const char* name;
  double from_m, to_m, from_deg, to_deg;

  bool has(double distance_m, double yaw_deg) const {
    return distance_m >= from_m && distance_m <= to_m && std::abs(yaw_deg) >= from_deg &&
           std::abs(yaw_deg) < to_deg;
  }
};

constexpr MarkerGroup kGroups[] = {
    {"1 to 3 m, below 50°", 1.0, 3.0, 0.0, 50.0},     {"4 m, below 35°", 4.0, 4.0, 0.0, 35.0},
    {"1 to 3 m, 50° and more", 1.0, 3.0, 50.0, 90.0}, {"1 m, below 50°", 1.0, 1.0, 0.0, 50.0},
    {"1.5 m, below 50°", 1.5, 1.5, 0.0, 50.0},        {"2 m, below 50°", 2.0, 2.0, 0.0, 50.0},
    {"3 m, below 50°", 3.0, 3.0, 0.0, 50.0}};

/// A marker's answer in the form of heel's, so that the same figures are made of it.
ForeignSample as_foreign(const MarkerSample& marker) {
  ForeignSample s;
  s.method = marker.method;
  s.image = marker.same_scene_as;
  s.distance_m = marker.distance_m;
  s.yaw_set_deg = marker.yaw_set_deg;
  s.yaw_back_deg = marker.yaw_back_deg;
  s.found = marker.found;
  s.yaw_deg = marker.yaw_deg;
  s.distance_ratio = 1.0;
  return s;
}

std::string cells(const ForeignFigures& f, std::size_t found) {
  std::string text = fmt::format(" {:.0f} % |", 100.0 * f.share(found));
  if (f.found == 0) return text + " – | – |";
  return text + fmt::format(" {:.1f} / {:.1f} / {:.1f}° | {} of {} |", f.yaw_mean_deg, f.yaw_median_deg,
                            f.yaw_p95_deg, f.flips, f.turned);
}

}  // namespace

std::vector<MarkerSample> read_markers(const std::string& path) {
  const CsvTable table(path);
  std::vector<MarkerSample> markers;
  for (std::size_t row = 0; row < table.rows(); ++row)
    markers.push_back({table.text(row, "method"), table.text(row, "same_scene_as"),
                       table.number(row, "distance_m"), table.number(row, "yaw_set_deg"),
                       table.number(row, "yaw_back_deg"), table.number(row, "found") != 0.0,
                       table.number(row, "yaw_deg")});
  return markers;
}

std::string marker_table(const std::vector<MarkerSample>& markers, const std::vector<ForeignSample>& heel) {
  std::map<std::string, std::vector<ForeignSample>> by_method;
  std::set<std::string> scenes;
  for (const MarkerSample& marker : markers) {
    by_method[marker.method].push_back(as_foreign(marker));
    scenes.insert(marker.same_scene_as);
  }
  for (const ForeignSample& s : heel)
    if (scenes.contains(s.image)) by_method["heel"].push_back(s);
  std::string text =
      "| scenes | | pictures | found | yaw error: mean / median / 95 % | wrong side "
      "|\n|---|---|---|---|---|---|\n";
  for (const MarkerGroup& group : kGroups) {
    for (const auto& [method, samples] : by_method) {
      const ForeignFigures f = foreign_figures(
          chosen(samples, [&](const ForeignSample& s) { return group.has(s.distance_m, s.yaw_set_deg); }));
      // Of heel only what it calls reliable counts as found.
      const std::size_t found = method == "heel" ? f.sure : f.found;
      if (f.pictures > 0)
        text += fmt::format("| {} | {} | {} |{}\n", group.name, method, f.pictures, cells(f, found));
    }
  }
  return text;
}

}  // namespace heel::evaluation
