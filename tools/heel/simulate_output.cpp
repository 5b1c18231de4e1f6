#include "simulate_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/angles.h"

namespace heel::cli {
namespace {

double rest_s(const evaluation::FollowMetrics& m) {
  double sum = 0.0;
  for (const auto& [reason, seconds] : m.rest_s_by_reason) sum += seconds;
  return sum;
}

std::string table_row(const SimulatedRun& run) {
  if (!run.refused.empty()) return fmt::format("{:<20} refused: {}\n", run.scenario, run.refused);
  const evaluation::FollowMetrics& m = run.metrics;
  const double found_percent =
      m.frames > 0 ? 100.0 * static_cast<double>(m.frames_found) / static_cast<double>(m.frames) : 0.0;
  return fmt::format(
      "{:<20} {:6.1f} {:6.1f} {:6.3f} {:6.2f} {:6.2f} {:6.2f} {:6.1f} {:6} {:6.2f} {:6.2f} {:6.2f} "
      "{:6.2f}{}\n",
      run.scenario, m.person_path_m, m.robot_path_m, m.lateral_m.rms,
      std::max(std::abs(m.lateral_m.lowest), std::abs(m.lateral_m.highest)), m.separation_m.mean,
      m.separation_end_m, found_percent, m.frames_wrong, m.out_of_view_longest_s,
      m.truly_out_of_view_longest_s, kDegPerRad * m.yaw_error_rad.rms, rest_s(m),
      m.touching_s > 0.0 ? "  TOUCHED" : "");
}

}  // namespace

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
  std::string text = fmt::format("person walked {:.2f} m, robot {:.2f} m\n", m.person_path_m, m.robot_path_m);
  text += fmt::format("beside the person's path: {:.3f} m RMS, {:.3f} to {:.3f} m\n", m.lateral_m.rms,
                      m.lateral_m.lowest, m.lateral_m.highest);
  text += fmt::format("separation: {:.2f} m mean, {:.2f} to {:.2f} m\n", m.separation_m.mean,
                      m.separation_m.lowest, m.separation_m.highest);
  text += fmt::format("found in {} of {} frames, longest out of view {:.2f} s, in all {:.2f} s\n",
                      m.frames_found, m.frames, m.out_of_view_longest_s, m.out_of_view_total_s);
  if (m.frames_wrong > 0)
    text += fmt::format("found something else in {} frames, over {:.1f} m from the target\n", m.frames_wrong,
                        evaluation::kWrong_m);
  text += fmt::format("certainty 5/50/95 %: {:.2f} {:.2f} {:.2f}\n", m.certainty.p05, m.certainty.p50,
                      m.certainty.p95);
  text += fmt::format(
      "yaw error: mean {:+.2f}, deviation {:.2f}, 5/95 % {:+.1f} {:+.1f} degrees; (error/sigma)^2 {:.2f}\n",
      kDegPerRad * m.yaw_error_rad.mean, kDegPerRad * m.yaw_error_rad.deviation,
      kDegPerRad * m.yaw_error_rad.p05, kDegPerRad * m.yaw_error_rad.p95, m.yaw_nees);
  text += fmt::format("position error RMS: x {:.3f}, y {:.3f}, z {:.3f} m (z mean {:+.3f} m)\n",
                      m.x_error_m.rms, m.y_error_m.rms, m.z_error_m.rms, m.z_error_m.mean);
  for (const auto& [reason, seconds] : m.rest_s_by_reason) {
    const auto stops = m.stops_by_reason.find(reason);
    text += fmt::format("stopped {} times: {} ({:.2f} s)\n",
                        stops == m.stops_by_reason.end() ? 0 : stops->second, reason, seconds);
  }
  if (m.touching_s > 0.0) text += fmt::format("touched something for {:.2f} s\n", m.touching_s);
  text +=
      fmt::format("{} ticks, {} frames ({} overtaken, {} dropped), {:.1f} x real time\n", run.counts.ticks,
                  run.counts.frames, run.counts.frames_overtaken, run.counts.frames_dropped, run.speed);
  return text;
}

std::string table_text(const std::vector<SimulatedRun>& runs) {
  constexpr const char* kHead =
      "{:<20} {:>6} {:>6} {:>6} {:>6} {:>6} {:>6} {:>6} {:>6} {:>6} {:>6} {:>6} {:>6}\n";
  std::string text = fmt::format(fmt::runtime(kHead), "", "walked", "drove", "beside", "worst", "gap", "end",
                                 "found", "wrong", "lost", "hidden", "yaw", "rest");
  text += fmt::format(fmt::runtime(kHead), "scenario", "m", "m", "m RMS", "m", "m", "gap m", "%", "frames",
                      "s", "s", "deg", "s");
  for (const SimulatedRun& run : runs) text += table_row(run);
  text += '\n';
  for (const SimulatedRun& run : runs) text += fmt::format("{:<20} {}\n", run.scenario, run.shows);
  text +=
      "\nbeside, worst: the robot's distance from the person's path. gap: robot to person. wrong: found in "
      "a\n"
      "wrong place. lost: longest time between two frames in which the shirt was found; hidden: longest time "
      "in\n"
      "which the back was out of the camera's sight. yaw: RMS error. rest: not following while the person "
      "walked.\n";
  return text;
}

}  // namespace heel::cli
