#include "evaluation/reports/run_numbers.h"

#include <algorithm>

#include "core/angles.h"
#include "files/csv_file.h"

namespace heel::evaluation {
namespace {

constexpr int kTimeDecimals = 3, kLengthDecimals = 4, kAngleDecimals = 3, kShareDecimals = 4;

double begin_s(const MetricsCollector& run) {
  return run.motion().empty() ? 0.0 : run.motion().front().t_s;
}

bool walking(const FollowMetrics& metrics, double t_s) {
  return t_s >= metrics.t_walk_begin_s && t_s <= metrics.t_walk_end_s;
}

/// The robot's place at a time; NaN after the last row of truth.
Pose2 robot_at(const std::vector<MotionSample>& motion, double t_s) {
  const auto at = std::lower_bound(motion.begin(), motion.end(), t_s,
                                   [](const MotionSample& s, double t) { return s.t_s < t; });
  return at == motion.end() ? Pose2{kNoValue, kNoValue, kNoValue} : at->robot;
}

void write_path(const std::string& path, const MetricsCollector& run, const FollowMetrics& metrics) {
  CsvFile file(path, "t_s,walking,robot_x_m,robot_y_m,person_x_m,person_y_m");
  for (const MotionSample& sample : run.motion()) {
    file.number(sample.t_s - begin_s(run), kTimeDecimals).count(walking(metrics, sample.t_s) ? 1 : 0);
    file.number(sample.robot.x_m, kLengthDecimals).number(sample.robot.y_m, kLengthDecimals);
    file.number(sample.has_person ? sample.person.x_m : kNoValue, kLengthDecimals);
    file.number(sample.has_person ? sample.person.y_m : kNoValue, kLengthDecimals);
    file.end_row();
  }
  file.flush();
}

void write_pose_errors(const std::string& path, const MetricsCollector& run, const FollowMetrics& metrics) {
  CsvFile file(path,
               "t_s,walking,found,certainty,yaw_deg,true_yaw_deg,x_m,true_x_m,z_m,true_z_m,"
               "robot_x_m,robot_y_m");
  for (const PoseSample& pose : run.poses()) {
    const auto shown = [&](double value) { return pose.found && pose.has_truth ? value : kNoValue; };
    const Pose2 robot = robot_at(run.motion(), pose.t_s);
    file.number(pose.t_s - begin_s(run), kTimeDecimals).count(walking(metrics, pose.t_s) ? 1 : 0);
    file.count(pose.found ? 1 : 0).number(pose.found ? pose.certainty : 0.0, kShareDecimals);
    file.number(shown(kDegPerRad * pose.yaw_rad), kAngleDecimals);
    file.number(shown(kDegPerRad * pose.true_yaw_rad), kAngleDecimals);
    file.number(shown(pose.x_m), kLengthDecimals).number(shown(pose.true_x_m), kLengthDecimals);
    file.number(shown(pose.z_m), kLengthDecimals).number(shown(pose.true_z_m), kLengthDecimals);
    file.number(robot.x_m, kLengthDecimals).number(robot.y_m, kLengthDecimals);
    file.end_row();
  }
  file.flush();
}

void write_commands(const std::string& path, const MetricsCollector& run) {
  CsvFile file(path, "t_s,v_m_s,yaw_rate_rad_s");
  for (const TickSample& tick : run.ticks()) {
    file.number(tick.t_s - begin_s(run), kTimeDecimals);
    file.number(tick.v_m_s, kShareDecimals).number(tick.yaw_rate_rad_s, kShareDecimals);
    file.end_row();
  }
  file.flush();
}

}  // namespace

void write_run_numbers(const std::string& directory, const MetricsCollector& run,
                       const FollowMetrics& metrics) {
  write_path(directory + "/path.csv", run, metrics);
  write_pose_errors(directory + "/pose_errors.csv", run, metrics);
  write_commands(directory + "/commands.csv", run);
  write_kept_frames(directory, begin_s(run));
}

}  // namespace heel::evaluation
