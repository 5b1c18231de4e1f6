#include "evaluation/reports/run_files.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/angles.h"
#include "files/csv_table.h"
#include "heel/error.h"

namespace heel::evaluation {
namespace {

constexpr double kTruthGap_s = 0.2;  ///< farther from any row of truth, a pose has no truth

struct TargetRow {
  double t_s, yaw_rad, x_m, y_m, z_m;
};

std::vector<TargetRow> read_truth(const CsvTable& truth, MetricsCollector& run) {
  std::vector<TargetRow> targets;
  const std::string time = truth.has("t_monotonic_s") ? "t_monotonic_s" : "t_s";
  const bool has_person = truth.has("person_x_m");
  const bool has_occluded = truth.has("target_occluded");
  const bool has_back = truth.has("back_x_m");
  for (std::size_t i = 0; i < truth.rows(); ++i) {
    MotionSample sample;
    sample.t_s = truth.number(i, time);
    if (i > 0 && !(sample.t_s >= run.motion().back().t_s))
      throw Error(truth.place(i) + ": " + time + " goes back (expected rows in order of time)");
    sample.robot = {truth.number(i, "robot_x_m"), truth.number(i, "robot_y_m"),
                    truth.number(i, "robot_heading_rad")};
    sample.has_person = has_person;
    if (has_person) {
      sample.person = {truth.number(i, "person_x_m"), truth.number(i, "person_y_m"),
                       truth.number(i, "person_heading_rad")};
      sample.person_speed_m_s = truth.number(i, "person_speed_m_s");
      sample.back_hidden = has_occluded && truth.number(i, "target_occluded") != 0.0;
      sample.back_in_view = truth.number(i, "target_in_view") != 0.0 && !sample.back_hidden;
      sample.has_back = has_back;
      sample.back_yaw_rad = truth.number(i, "target_yaw_rad");
      if (has_back) {
        sample.back_x_m = truth.number(i, "back_x_m");
        sample.back_y_m = truth.number(i, "back_y_m");
      }
      targets.push_back({sample.t_s, truth.number(i, "target_yaw_rad"), truth.number(i, "target_x_m"),
                         truth.number(i, "target_y_m"), truth.number(i, "target_z_m")});
    }
    run.add(sample);
  }
  return targets;
}

/// The truth at the pose's capture time, between the two rows about it.
void add_truth(const std::vector<TargetRow>& targets, PoseSample& pose) {
  const auto after = std::lower_bound(targets.begin(), targets.end(), pose.t_s,
                                      [](const TargetRow& row, double t_s) { return row.t_s < t_s; });
  if (after == targets.begin() || after == targets.end()) return;
  const TargetRow& b = *after;
  const TargetRow& a = *(after - 1);
  if (b.t_s - a.t_s > kTruthGap_s) return;
  const double f = (pose.t_s - a.t_s) / (b.t_s - a.t_s);
  pose.has_truth = true;
  pose.true_yaw_rad = a.yaw_rad + f * wrap_angle_rad(b.yaw_rad - a.yaw_rad);
  pose.true_x_m = a.x_m + f * (b.x_m - a.x_m);
  pose.true_y_m = a.y_m + f * (b.y_m - a.y_m);
  pose.true_z_m = a.z_m + f * (b.z_m - a.z_m);
}

}  // namespace

MetricsCollector read_run(const std::string& directory) {
  MetricsCollector run;
  const std::vector<TargetRow> targets = read_truth(CsvTable(directory + "/truth.csv"), run);
  const CsvTable ticks(directory + "/ticks.csv");
  for (std::size_t i = 0; i < ticks.rows(); ++i)
    run.add(TickSample{ticks.number(i, "t_s"), ticks.text(i, "stop_reason"), ticks.number(i, "command_v_m_s"),
                       ticks.number(i, "command_yaw_rate_rad_s")});
  const CsvTable poses(directory + "/poses.csv");
  for (std::size_t i = 0; i < poses.rows(); ++i) {
    PoseSample pose;
    pose.t_s = poses.number(i, "t_s");
    pose.found = poses.number(i, "found") != 0.0;
    pose.reason = poses.text(i, "reason");
    pose.certainty = poses.number(i, "certainty");
    pose.yaw_rad = poses.number(i, "frame_yaw_rad");
    pose.yaw_sigma_rad = poses.number(i, "frame_yaw_sigma_rad");
    pose.x_m = poses.number(i, "position_m_0");
    pose.y_m = poses.number(i, "position_m_1");
    pose.z_m = poses.number(i, "position_m_2");
    if (pose.found && std::isfinite(pose.z_m)) add_truth(targets, pose);
    run.add(pose);
  }
  return run;
}

}  // namespace heel::evaluation
