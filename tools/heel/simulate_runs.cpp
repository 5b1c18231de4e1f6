#include "simulate_runs.h"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <filesystem>

#include "heel/error.h"

namespace heel::cli {
namespace {

constexpr double kDeg = 57.29577951308232;

[[gnu::format(printf, 2, 3)]] void add_line(std::string& text, const char* format, ...) {
  char line[400];
  va_list values;
  va_start(values, format);
  std::vsnprintf(line, sizeof line, format, values);
  va_end(values);
  text += line;
  text += '\n';
}

unsigned long long count(std::uint64_t value) {
  return value;
}

double at_rest_s(const evaluation::FollowMetrics& m) {
  double sum = 0.0;
  for (const auto& [reason, rest_s] : m.rest_s_by_reason) sum += rest_s;
  return sum;
}

}  // namespace

std::vector<std::string> scenario_files(const std::vector<std::string>& arguments) {
  namespace fs = std::filesystem;
  std::vector<std::string> files;
  for (const std::string& argument : arguments) {
    if (!fs::is_directory(argument)) {
      files.push_back(argument);
      continue;
    }
    std::vector<std::string> found;
    for (const auto& entry : fs::directory_iterator(argument))
      if (entry.path().extension() == ".toml") found.push_back(entry.path().string());
    if (found.empty()) throw Error(argument + ": no scenario in this folder (expected *.toml)");
    std::sort(found.begin(), found.end());
    files.insert(files.end(), found.begin(), found.end());
  }
  return files;
}

nlohmann::ordered_json to_json(const SimulatedRun& run) {
  nlohmann::ordered_json json{{"scenario", run.scenario}, {"seed", run.seed}};
  if (!run.refused.empty()) {
    json["refused"] = run.refused;
    return json;
  }
  json["ticks"] = run.counts.ticks;
  json["frames_overtaken"] = run.counts.frames_overtaken;
  json["frames_dropped"] = run.counts.frames_dropped;
  json.update(evaluation::to_json(run.metrics));
  json["failed"] = run.failed;
  return json;
}

std::string detailed_text(const SimulatedRun& run) {
  const evaluation::FollowMetrics& m = run.metrics;
  std::string text;
  add_line(text, "person walked %.2f m, robot %.2f m", m.person_path_m, m.robot_path_m);
  add_line(text, "beside the person's path: %.3f m RMS, %.3f to %.3f m", m.lateral_m.rms, m.lateral_m.lowest,
           m.lateral_m.highest);
  add_line(text, "separation: %.2f m mean, %.2f to %.2f m", m.separation_m.mean, m.separation_m.lowest,
           m.separation_m.highest);
  add_line(text, "found in %llu of %llu frames, longest out of view %.2f s, in all %.2f s",
           count(m.frames_found), count(m.frames), m.out_of_view_longest_s, m.out_of_view_total_s);
  if (m.frames_wrong > 0)
    add_line(text, "found something else in %llu frames, over %.1f m from the target", count(m.frames_wrong),
             evaluation::kWrong_m);
  add_line(text, "certainty 5/50/95 %%: %.2f %.2f %.2f", m.certainty.p05, m.certainty.p50, m.certainty.p95);
  add_line(text, "yaw error: mean %+.2f, deviation %.2f, 5/95 %% %+.1f %+.1f degrees; (error/sigma)^2 %.2f",
           kDeg * m.yaw_error_rad.mean, kDeg * m.yaw_error_rad.deviation, kDeg * m.yaw_error_rad.p05,
           kDeg * m.yaw_error_rad.p95, m.yaw_nees);
  add_line(text, "position error RMS: x %.3f, y %.3f, z %.3f m (z mean %+.3f m)", m.x_error_m.rms,
           m.y_error_m.rms, m.z_error_m.rms, m.z_error_m.mean);
  for (const auto& [reason, rest_s] : m.rest_s_by_reason) {
    const auto times = m.stops_by_reason.find(reason);
    add_line(text, "stopped %d times: %s (%.2f s)", times == m.stops_by_reason.end() ? 0 : times->second,
             reason.c_str(), rest_s);
  }
  if (m.touching_s > 0.0) add_line(text, "touched something for %.2f s", m.touching_s);
  add_line(text, "%llu ticks, %llu frames (%llu overtaken, %llu dropped), %.1f x real time",
           count(run.counts.ticks), count(run.counts.frames), count(run.counts.frames_overtaken),
           count(run.counts.frames_dropped), run.times_real);
  return text;
}

std::string table_text(const std::vector<SimulatedRun>& runs) {
  std::string text;
  add_line(text, "%-20s %6s %6s %6s %6s %6s %6s %6s %6s %6s %6s %6s %6s", "", "walked", "drove", "beside",
           "worst", "gap", "end", "found", "wrong", "lost", "hidden", "yaw", "rest");
  add_line(text, "%-20s %6s %6s %6s %6s %6s %6s %6s %6s %6s %6s %6s %6s", "scenario", "m", "m", "m RMS", "m",
           "m", "gap m", "%", "frames", "s", "s", "deg", "s");
  for (const SimulatedRun& run : runs) {
    if (!run.refused.empty()) {
      add_line(text, "%-20s refused: %s", run.scenario.c_str(), run.refused.c_str());
      continue;
    }
    const evaluation::FollowMetrics& m = run.metrics;
    const double found =
        m.frames > 0 ? 100.0 * static_cast<double>(m.frames_found) / static_cast<double>(m.frames) : 0.0;
    add_line(text, "%-20s %6.1f %6.1f %6.3f %6.2f %6.2f %6.2f %6.1f %6llu %6.2f %6.2f %6.2f %6.2f%s",
             run.scenario.c_str(), m.person_path_m, m.robot_path_m, m.lateral_m.rms,
             std::max(std::abs(m.lateral_m.lowest), std::abs(m.lateral_m.highest)), m.separation_m.mean,
             m.separation_end_m, found, count(m.frames_wrong), m.out_of_view_longest_s,
             m.truly_out_of_view_longest_s, kDeg * m.yaw_error_rad.rms, at_rest_s(m),
             m.touching_s > 0.0 ? "  TOUCHED" : "");
  }
  text += '\n';
  for (const SimulatedRun& run : runs) add_line(text, "%-20s %s", run.scenario.c_str(), run.shows.c_str());
  text +=
      "\nbeside, worst: robot's path from the person's. gap: robot to person. wrong: found, but elsewhere.\n"
      "lost: longest between two sightings; hidden: longest that nobody could have seen the back. yaw: RMS "
      "error.\nrest: not following while the person walked.\n";
  return text;
}

}  // namespace heel::cli
