#include "evaluation/experiments/many_runs.h"

#include <fmt/format.h>

#include <array>

namespace heel::evaluation {
namespace {

struct RunFigure {
  const char* name;
  double (*value)(const FollowMetrics& metrics);
};

int stops_of(const FollowMetrics& metrics) {
  int stops = 0;
  for (const auto& [reason, times] : metrics.stops_by_reason) stops += times;
  return stops;
}

constexpr std::array kFigures{
    RunFigure{"path_rms_m", [](const FollowMetrics& m) { return m.lateral_m.rms; }},
    RunFigure{"path_p95_m", [](const FollowMetrics& m) { return m.following.path_p95_m; }},
    RunFigure{"path_max_m", [](const FollowMetrics& m) { return m.following.path_max_m; }},
    RunFigure{"along_p95_m", [](const FollowMetrics& m) { return m.following.along_p95_m; }},
    RunFigure{"along_within_share", [](const FollowMetrics& m) { return m.following.along_within_share; }},
    RunFigure{"separation_entries",
              [](const FollowMetrics& m) { return static_cast<double>(m.following.separation_entries); }},
    RunFigure{"jerk_p99_m_s3", [](const FollowMetrics& m) { return m.following.jerk_p99_m_s3; }},
    RunFigure{"straight_yaw_rate_rms_rad_s",
              [](const FollowMetrics& m) { return m.following.straight_yaw_rate_rms_rad_s; }},
    RunFigure{"yaw_within_share", [](const FollowMetrics& m) { return m.following.yaw_within_share; }},
    RunFigure{"out_of_sight_share", [](const FollowMetrics& m) { return m.following.out_of_sight_share; }},
    RunFigure{"found_again_longest_s",
              [](const FollowMetrics& m) { return m.following.found_again_s.highest; }},
    RunFigure{"settled_s", [](const FollowMetrics& m) { return m.following.settled_s; }},
    RunFigure{"settled_walking_s", [](const FollowMetrics& m) { return m.following.settled_walking_s; }},
    RunFigure{"overshoot_share", [](const FollowMetrics& m) { return m.following.overshoot_share; }},
    RunFigure{"contacts", [](const FollowMetrics& m) { return static_cast<double>(m.following.contacts); }},
    RunFigure{"contacts_moving",
              [](const FollowMetrics& m) {
                return static_cast<double>(m.following.contacts - m.following.contacts_at_rest);
              }},
    RunFigure{"followed_to_end",
              [](const FollowMetrics& m) { return m.following.followed_to_end ? 1.0 : 0.0; }},
    RunFigure{"separation_mean_m", [](const FollowMetrics& m) { return m.separation_m.mean; }},
    RunFigure{"separation_least_m", [](const FollowMetrics& m) { return m.separation_m.lowest; }},
    RunFigure{"found_share",
              [](const FollowMetrics& m) {
                return m.frames > 0 ? static_cast<double>(m.frames_found) / static_cast<double>(m.frames)
                                    : 0.0;
              }},
    RunFigure{"out_of_view_longest_s", [](const FollowMetrics& m) { return m.out_of_view_longest_s; }},
    RunFigure{"robot_path_m", [](const FollowMetrics& m) { return m.robot_path_m; }},
    RunFigure{"stops", [](const FollowMetrics& m) { return static_cast<double>(stops_of(m)); }},
};

Quantiles over_runs(const ManyRuns& many, const RunFigure& figure) {
  std::vector<double> values;
  for (const FollowMetrics& metrics : many.runs) values.push_back(figure.value(metrics));
  return quantiles(values);
}

}  // namespace

nlohmann::ordered_json to_json(const ManyRuns& many) {
  nlohmann::ordered_json json{{"runs", many.runs.size()}, {"simulated_s", many.simulated_s}};
  for (const RunFigure& figure : kFigures) {
    const Quantiles q = over_runs(many, figure);
    json[figure.name] = {
        {"mean", q.mean}, {"deviation", q.deviation}, {"min", q.lowest}, {"p05", q.p05}, {"p50", q.p50},
        {"p95", q.p95},   {"max", q.highest}};
  }
  return json;
}

std::string many_runs_table(const ManyRuns& many) {
  std::string text = fmt::format("{:<28} {:>9} {:>9} {:>9} {:>9} {:>9}\n", "over runs", "mean", "deviation",
                                 "least", "median", "most");
  for (const RunFigure& figure : kFigures) {
    const Quantiles q = over_runs(many, figure);
    text += fmt::format("{:<28} {:9.3f} {:9.3f} {:9.3f} {:9.3f} {:9.3f}\n", figure.name, q.mean, q.deviation,
                        q.lowest, q.p50, q.highest);
  }
  return text;
}

}  // namespace heel::evaluation
