#include "evaluation/reports/run_files.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/angles.h"
#include "files/csv_table.h"
#include "heel/error.h"
#include "recording/recording_reader.h"

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

/// Ticks and poses as samples; a pose with the truth at its time.
class RunRecording final : public RecordingVisitor {
 public:
  RunRecording(const std::vector<TargetRow>& targets, MetricsCollector& run) : targets_(targets), run_(run) {}

  void on_tick(const TickRecord& tick) override {
    run_.add(TickSample{seconds_from_ns(tick.input.now_ns), to_string(tick.stop_reason), tick.command.v_m_s,
                        tick.command.yaw_rate_rad_s});
  }
  void on_pose(const PoseEstimate& pose) override {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    PoseSample sample;
    sample.t_s = seconds_from_ns(pose.t_capture_ns);
    sample.found = pose.found();
    sample.reason = to_string(pose.reason);
    sample.certainty = pose.certainty;
    sample.yaw_rad = pose.found() ? pose.frame_yaw_rad : kNone;
    sample.yaw_sigma_rad = pose.found() ? pose.frame_yaw_sigma_rad : kNone;
    const bool placed = pose.found() && pose.has_distance;
    sample.x_m = placed ? pose.position_m[0] : kNone;
    sample.y_m = placed ? pose.position_m[1] : kNone;
    sample.z_m = placed ? pose.position_m[2] : kNone;
    if (placed && std::isfinite(sample.z_m)) add_truth(targets_, sample);
    run_.add(sample);
  }
  bool wants(std::string_view topic) const override { return topic == "/heel/tick" || topic == "/heel/pose"; }

 private:
  const std::vector<TargetRow>& targets_;
  MetricsCollector& run_;
};

}  // namespace

MetricsCollector read_run(const std::string& directory) {
  MetricsCollector run;
  const std::vector<TargetRow> targets = read_truth(CsvTable(directory + "/truth.csv"), run);
  RunRecording recording(targets, run);
  read_recording(recording_in(directory), recording);
  return run;
}

}  // namespace heel::evaluation
