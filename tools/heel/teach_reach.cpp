#include "teach_reach.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <vector>

#include "commandline/progress.h"

namespace heel::cli {
namespace {

using Clock = std::chrono::steady_clock;

std::string in_degrees(double angle_rad) {
  return fmt::format("{:.0f}°", angle_rad * 180.0 / M_PI);
}

/// Distances to the right, turns down; blank where nothing was measured.
void print_table(const TemplateReach& reach) {
  std::vector<double> distances_m, turns_rad;
  for (const ReachCell& cell : reach.cells) {
    if (std::find(distances_m.begin(), distances_m.end(), cell.distance_m) == distances_m.end())
      distances_m.push_back(cell.distance_m);
    if (std::find(turns_rad.begin(), turns_rad.end(), cell.turn_rad) == turns_rad.end())
      turns_rad.push_back(cell.turn_rad);
  }
  std::sort(distances_m.begin(), distances_m.end());
  std::sort(turns_rad.begin(), turns_rad.end());
  std::string line = "    turned    m";
  for (const double distance_m : distances_m) line += fmt::format(" {:5}", distance_m);
  fmt::print("{}\n", line);
  for (const double turn_rad : turns_rad) {
    line = fmt::format("    {:>{}} ", in_degrees(turn_rad), 10);
    for (const double distance_m : distances_m) {
      const auto cell = std::find_if(reach.cells.begin(), reach.cells.end(), [&](const ReachCell& one) {
        return one.turn_rad == turn_rad && one.distance_m == distance_m;
      });
      line += cell == reach.cells.end() ? "      " : fmt::format("   {}/{}", cell->found, cell->pictures);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    fmt::print("{}\n", line);
  }
}

}  // namespace

std::string in_one_line(const TemplateReach& reach) {
  if (reach.cells.empty()) return "how far it is found was not measured";
  if (reach.far_m == 0.0) return "found at no distance";
  std::string line = fmt::format("found from {} to {} m facing away", reach.near_m, reach.far_m);
  if (reach.turn_rad)
    line += fmt::format(", to {} at {} m", in_degrees(*reach.turn_rad), TemplateReach::kTurnDistance_m);
  return line;
}

TemplateReach measured_reach(const ShirtTemplate& shirt, const CameraModel& robot_camera, double longest_s) {
  const Clock::time_point start = Clock::now();
  commandline::Progress progress("measuring how far it is found: pictures, at most");
  return measure_reach(shirt, robot_camera, VisionConfig{}, [&](int done, int most) {
    progress.show(static_cast<std::uint64_t>(done), static_cast<std::uint64_t>(most));
    return std::chrono::duration<double>(Clock::now() - start).count() < longest_s;
  });
}

void print_reach(const TemplateReach& reach, double longest_s) {
  const std::string limit =
      reach.complete ? "" : fmt::format(" (not measured further after {} s: --reach-time)", longest_s);
  fmt::print("{}{}\n", in_one_line(reach), limit);
  if (!reach.cells.empty()) print_table(reach);
  const std::string warning = reach_warning(reach);
  if (!warning.empty()) fmt::print("warning: {}\n", warning);
}

nlohmann::ordered_json reach_json(const TemplateReach& reach) {
  nlohmann::ordered_json json{{"near_m", reach.near_m},
                              {"far_m", reach.far_m},
                              {"turn_rad", nullptr},
                              {"complete", reach.complete},
                              {"warning", reach_warning(reach)},
                              {"cells", nlohmann::ordered_json::array()}};
  if (reach.turn_rad) json["turn_rad"] = *reach.turn_rad;
  for (const ReachCell& cell : reach.cells)
    json["cells"].push_back({{"distance_m", cell.distance_m},
                             {"turn_rad", cell.turn_rad},
                             {"found", cell.found},
                             {"pictures", cell.pictures}});
  return json;
}

}  // namespace heel::cli
