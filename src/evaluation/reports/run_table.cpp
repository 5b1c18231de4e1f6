#include "evaluation/reports/run_table.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/angles.h"
#include "evaluation/reports/still_samples.h"

namespace heel::evaluation {
namespace {

/// More than this between two sightings: one frame at least did not show the target.
constexpr double kLossFrames = 1.5;

bool wrong(const PoseSample& pose) {
  return is_wrong(wrap_angle_rad(pose.yaw_rad - pose.true_yaw_rad),
                  std::hypot(pose.x_m - pose.true_x_m, pose.z_m - pose.true_z_m), pose.true_z_m);
}

double frame_period_s(const MetricsCollector& run) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < run.poses().size(); ++i)
    steps.push_back(run.poses()[i].t_s - run.poses()[i - 1].t_s);
  return quantiles(steps).p50;
}

}  // namespace

RunLine run_line(const std::string& name, const MetricsCollector& run) {
  RunLine line;
  line.name = name;
  line.metrics = run.evaluate();
  const double period_s = frame_period_s(run);
  double t_found_s = line.metrics.t_walk_begin_s;
  for (const PoseSample& pose : run.poses()) {
    if (pose.t_s < line.metrics.t_walk_begin_s || pose.t_s > line.metrics.t_walk_end_s) continue;
    ++line.frames;
    const auto truth = std::lower_bound(run.motion().begin(), run.motion().end(), pose.t_s,
                                        [](const MotionSample& s, double t) { return s.t_s < t; });
    const bool visible = truth != run.motion().end() && truth->back_in_view;
    if (visible) ++line.visible;
    if (!pose.found) continue;
    ++line.found;
    if (visible) ++line.found_of_visible;
    if (pose.has_truth && wrong(pose)) ++line.wrong;
    if (pose.t_s - t_found_s > kLossFrames * period_s) line.gaps_s.push_back(pose.t_s - t_found_s);
    t_found_s = pose.t_s;
  }
  return line;
}

std::string run_table(const std::vector<RunLine>& lines) {
  std::string text =
      "| run | walked | frames | found | of those in view | wrong | times lost | found again after (mean, "
      "longest) "
      "| path RMS | stops |\n|---|---|---|---|---|---|---|---|---|---|\n";
  for (const RunLine& line : lines) {
    const Quantiles gaps = quantiles(line.gaps_s);
    const auto share = [](std::size_t part, std::size_t whole) {
      return whole > 0 ? 100.0 * static_cast<double>(part) / static_cast<double>(whole) : 0.0;
    };
    int stops = 0;
    for (const auto& [reason, times] : line.metrics.stops_by_reason) stops += times;
    char row[320];
    std::snprintf(
        row, sizeof row,
        "| %s | %.1f m | %zu | %.1f %% | %.1f %% | %.2f %% | %zu | %.2f s, %.2f s | %.3f m | %d |\n",
        line.name.c_str(), line.metrics.person_path_m, line.frames, share(line.found, line.frames),
        share(line.found_of_visible, line.visible), share(line.wrong, line.found), line.gaps_s.size(),
        gaps.mean, gaps.highest, line.metrics.lateral_m.rms, stops);
    text += row;
  }
  return text;
}

std::string worlds_table(const std::vector<RunLine>& pictured, const std::vector<RunLine>& without) {
  std::string rows;
  for (const RunLine& a : pictured)
    for (const RunLine& b : without) {
      if (a.name != b.name) continue;
      const auto found = [](const RunLine& line) {
        return line.frames > 0 ? 100.0 * static_cast<double>(line.found) / static_cast<double>(line.frames)
                               : 0.0;
      };
      char row[400];
      std::snprintf(
          row, sizeof row,
          "| %s | %.3f, %.3f m | %.2f, %.2f m | %.1f, %.1f m | %.1f, %.1f %% | %.2f, %.2f | %+.1f ± %.1f, "
          "%+.1f ± %.1f deg |\n",
          a.name.c_str(), a.metrics.lateral_m.rms, b.metrics.lateral_m.rms, a.metrics.separation_m.mean,
          b.metrics.separation_m.mean, a.metrics.robot_path_m, b.metrics.robot_path_m, found(a), found(b),
          a.metrics.certainty.p50, b.metrics.certainty.p50, kDegPerRad * a.metrics.yaw_error_rad.mean,
          kDegPerRad * a.metrics.yaw_error_rad.deviation, kDegPerRad * b.metrics.yaw_error_rad.mean,
          kDegPerRad * b.metrics.yaw_error_rad.deviation);
      rows += row;
    }
  if (rows.empty()) return rows;
  return "| run: pictured, without pictures | path RMS | separation | robot's way | found | certainty | yaw "
         "error |\n"
         "|---|---|---|---|---|---|---|\n" +
         rows;
}

}  // namespace heel::evaluation
