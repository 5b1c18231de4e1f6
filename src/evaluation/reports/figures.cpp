#include "evaluation/reports/figures.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <opencv2/imgproc.hpp>

#include "evaluation/reports/plot.h"
#include "evaluation/reports/style.h"

namespace heel::evaluation {
namespace {

const cv::Scalar kLost(40, 40, 220);
const cv::Scalar kTruth(150, 150, 150);
constexpr int kWidth_px = 1100, kPathHeight_px = 740, kPanelHeight_px = 270;

/// The robot's place at a time.
cv::Point2d robot_at(const std::vector<MotionSample>& motion, double t_s) {
  const auto at = std::lower_bound(motion.begin(), motion.end(), t_s,
                                   [](const MotionSample& s, double t) { return s.t_s < t; });
  if (at == motion.end()) return {kNaN, kNaN};
  return {at->robot.x_m, at->robot.y_m};
}

/// Seconds of the run, the same on every panel; times in panels count from its beginning.
Span run_span(const MetricsCollector& run) {
  if (run.motion().empty()) return {};
  return {0.0, run.motion().back().t_s - run.motion().front().t_s};
}

double begin_s(const MetricsCollector& run) {
  return run.motion().empty() ? 0.0 : run.motion().front().t_s;
}

cv::Mat panel(const MetricsCollector& run, const char* title, const char* label,
              const std::vector<Series>& series, bool y_from_zero = false) {
  return plot({title, "time in s", label, false, y_from_zero, run_span(run)}, series, kWidth_px,
              kPanelHeight_px);
}

cv::Mat error_panel(const MetricsCollector& run, const char* title, const char* label, double scale,
                    double PoseSample::*estimate, double PoseSample::*truth) {
  const double t0 = begin_s(run);
  Series measured{"estimated", kRobot, {}, 1.2, false};
  Series actual{"true", kTruth, {}, 2.6, false};
  for (const PoseSample& pose : run.poses()) {
    const bool shown = pose.found && pose.has_truth;
    measured.points.emplace_back(pose.t_s - t0, shown ? scale * pose.*estimate : kNaN);
    actual.points.emplace_back(pose.t_s - t0, shown ? scale * pose.*truth : kNaN);
  }
  return panel(run, title, label, {actual, measured});
}

cv::Mat certainty_panel(const MetricsCollector& run) {
  const double t0 = begin_s(run);
  Series certainty{"certainty", kRobot, {}, 1.2, false};
  for (const PoseSample& pose : run.poses())
    certainty.points.emplace_back(pose.t_s - t0, pose.found ? pose.certainty : 0.0);
  const Span span = run_span(run);
  const Series reliable{"reliable above 0.1", kTruth, {{span.low, 0.1}, {span.high, 0.1}}, 1.2, false};
  return panel(run, "Certainty: inliers / template features", "certainty", {reliable, certainty}, true);
}

cv::Mat command_panel(const MetricsCollector& run) {
  const double t0 = begin_s(run);
  Series speed{"speed in m/s", kRobot, {}, 1.4, false};
  Series turning{"yaw rate in rad/s, left positive", kPerson, {}, 1.4, false};
  for (const TickSample& tick : run.ticks()) {
    speed.points.emplace_back(tick.t_s - t0, tick.v_m_s);
    turning.points.emplace_back(tick.t_s - t0, tick.yaw_rate_rad_s);
  }
  return panel(run, "Commands to the robot", "m/s, rad/s", {turning, speed});
}

}  // namespace

cv::Mat path_figure(const MetricsCollector& run, const FollowMetrics& metrics) {
  Series person{"person", kPerson, {}, 2.4, false};
  Series robot{"robot", kRobot, {}, 2.4, false};
  Series ties{"at the same moment", cv::Scalar(190, 190, 190), {}, 0.8, false};
  double t_tie_s = metrics.t_walk_begin_s;
  for (const MotionSample& sample : run.motion()) {
    robot.points.emplace_back(sample.robot.x_m, sample.robot.y_m);
    if (!sample.has_person) continue;
    person.points.emplace_back(sample.person.x_m, sample.person.y_m);
    if (sample.t_s < t_tie_s) continue;
    // Every few seconds a thin line from the robot to the person of the same moment.
    t_tie_s += 4.0;
    ties.points.emplace_back(sample.robot.x_m, sample.robot.y_m);
    ties.points.emplace_back(sample.person.x_m, sample.person.y_m);
    ties.points.emplace_back(kNaN, kNaN);
  }
  Series lost{"target not found", kLost, {}, 2.0, true};
  for (const PoseSample& pose : run.poses())
    if (!pose.found && pose.t_s >= metrics.t_walk_begin_s && pose.t_s <= metrics.t_walk_end_s)
      lost.points.push_back(robot_at(run.motion(), pose.t_s));
  Series begin{"start", cv::Scalar(60, 160, 60), {}, 3.0, true};
  Series end{"end", cv::Scalar(30, 30, 30), {}, 3.0, true};
  for (const Series* path : {&person, &robot}) {
    if (path->points.empty()) continue;
    begin.points.push_back(path->points.front());
    end.points.push_back(path->points.back());
  }
  char title[160];
  std::snprintf(title, sizeof title,
                "Both paths: %.1f m walked, %.2f m RMS apart, longest out of view %.2f s",
                metrics.person_path_m, metrics.lateral_m.rms, metrics.out_of_view_longest_s);
  return plot({title, "x in m", "y in m", true, false, {}}, {ties, person, robot, lost, begin, end},
              kWidth_px, kPathHeight_px);
}

cv::Mat errors_figure(const MetricsCollector& run) {
  using P = PoseSample;
  const std::vector<cv::Mat> panels{
      error_panel(run, "Yaw of the back in the camera", "yaw in degrees", kDeg, &P::yaw_rad,
                  &P::true_yaw_rad),
      error_panel(run, "Sideways position", "t_x in m", 1.0, &P::x_m, &P::true_x_m),
      error_panel(run, "Distance", "t_z in m", 1.0, &P::z_m, &P::true_z_m), certainty_panel(run),
      command_panel(run)};
  cv::Mat out;
  cv::vconcat(panels, out);
  return out;
}

}  // namespace heel::evaluation
